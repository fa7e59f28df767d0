# SPDX-License-Identifier: MIT
"""A CMSIS-Pack: one component, whose description names every file of the core. Arm's own checker cannot be had, so that
the pack is read by cmsis-pack-manager (pyOCD's), and its component is built as a project's build system builds one: its
sources, with its folder of headers. Learns on an emulated Cortex-M3."""

import json
import shutil
import xml.etree.ElementTree as ET

import packing

NAME = "rlvc.rlvc"  # vendor and pack
FLAGS = ("-mcpu=cortex-m3", "-mthumb", "-std=gnu11", "-Os", "-ffunction-sections", "-fdata-sections",
         "--specs=picolibc.specs")
LINK = ("--crt0=semihost", "--oslib=semihost", "-Wl,--gc-sections", "-Wl,--defsym=__flash=0",
        "-Wl,--defsym=__flash_size=0x200000", "-Wl,--defsym=__ram=0x20000000", "-Wl,--defsym=__ram_size=0x10000")


def description(pack_folder):
    """The package description, in the order and with the attributes of the schema 1.7.32."""
    package = ET.Element("package", {"schemaVersion": "1.7.32"})

    def add(parent, tag, text=None, **attributes):
        element = ET.SubElement(parent, tag, attributes)
        element.text = text
        return element

    add(package, "vendor", NAME.split(".")[0])
    add(package, "name", NAME.split(".")[1])
    add(package, "description", packing.SUMMARY)
    add(package, "url", "https://example.org/rlvc/")
    add(package, "license", "LICENSE")
    add(add(package, "releases"), "release", "CHANGELOG.md says what changed.", version=packing.VERSION)
    component = add(add(package, "components"), "component", Cclass="Machine Learning", Cgroup="rlvc",
                    Cversion=packing.VERSION)
    add(component, "description", "Learns in a block of memory that the program provides")
    files = add(component, "files")
    add(files, "file", category="include", name="include/")
    for path in sorted(pack_folder.rglob("*.c")):
        add(files, "file", category="sourceC", name=path.relative_to(pack_folder).as_posix())
    ET.indent(package)
    return package


def pack(folder):
    made = folder / "rlvc"
    packing.copy_core(made)
    shutil.copy(packing.ROOT / "CHANGELOG.md", made)
    ET.ElementTree(description(made)).write(made / f"{NAME}.pdsc", encoding="utf-8", xml_declaration=True)
    return packing.pack_zip(made, folder / f"{NAME}.{packing.VERSION}.pack", within="")


def component_of(file):
    """The one component that cmsis-pack-manager finds in a description."""
    try:
        from cmsis_pack_manager.cmsis_pack_manager import ffi, lib
    except ImportError:
        raise packing.Skip("there is no cmsis-pack-manager") from None
    parsed = lib.parse_packs(lib.pack_from_path(ffi.new("char[]", str(file).encode())))
    text = lib.dumps_components(parsed)
    if not text:
        raise packing.Failed(f"{file.name} cannot be read")
    (component,) = json.loads(ffi.string(text))
    return component


def check(archive, folder):
    emulator = packing.tool(packing.EMULATED_M3[0])
    compiler = packing.tool("arm-none-eabi-gcc")
    place = packing.unpack(archive, folder / "elsewhere")
    (found,) = place.glob("*.pdsc")
    component = component_of(found)
    if f"{found.stem}.{component['version']}.pack" != archive.name:
        raise packing.Failed(f"{archive.name} holds {found.stem} {component['version']}")
    names = {kind: [place / file["path"] for file in component["files"] if file["category"] == kind]
             for kind in ("Include", "SourceC")}
    if len(names["SourceC"]) != sum(path.suffix == ".c" for path in packing.core_files()):
        raise packing.Failed(f"{len(names['SourceC'])} sources are named")
    packing.run(compiler, *FLAGS, *(f"-I{path}" for path in names["Include"]), packing.ROW, *names["SourceC"], *LINK,
                "-o", folder / "row.elf")
    packing.expect_row(packing.run(emulator, *packing.EMULATED_M3[1:], folder / "row.elf"), folder)
    return "read by cmsis-pack-manager, its component learnt on an emulated Cortex-M3 (packchk cannot be had)"
