# SPDX-License-Identifier: MIT
"""The bill of materials of a release, in CycloneDX's JSON: what rlvc consists of, what each part needs, and the archives
with their digests. The same archives give the same bytes."""

import hashlib
import re
import tomllib
import uuid

import packing

# What the vision module links; its CMakeLists.txt asks for these versions.
VISION_NEEDS = (("OpenCV", "Apache-2.0"), ("nlohmann-json", "MIT"))


def python_needs():
    """What the Python package needs: always, and for one of its extras."""
    with open(packing.ROOT / "pyproject.toml", "rb") as file:
        project = tomllib.load(file)["project"]
    always = {re.match(r"[\w-]+", each)[0] for each in project["dependencies"]}
    extras = project["optional-dependencies"]
    users = [name for name in extras if name not in ("docs", "test")]
    return always, {re.match(r"[\w-]+", each)[0] for name in users for each in extras[name]} - always


def make(archives):
    """The text, which is checked against the schema."""
    from cyclonedx.model import HashAlgorithm, HashType
    from cyclonedx.model.bom import Bom
    from cyclonedx.model.component import Component, ComponentScope, ComponentType
    from cyclonedx.model.license import DisjunctiveLicense
    from cyclonedx.output.json import JsonV1Dot6
    from cyclonedx.schema import SchemaVersion
    from cyclonedx.validation.json import JsonStrictValidator
    from packageurl import PackageURL

    bom = Bom(serial_number=uuid.uuid5(uuid.NAMESPACE_URL, f"https://example.org/rlvc/{packing.VERSION}"))

    def component(name, licence=None, **more):
        licences = [DisjunctiveLicense(id=licence)] if licence else []
        made = Component(name=name, bom_ref=more.pop("ref", name), licenses=licences,
                         **{"type": ComponentType.LIBRARY, **more})
        bom.components.add(made)
        return made

    ours = {"version": packing.VERSION, "licence": "MIT"}
    core = component("rlvc core", description="the C library; needs nothing", **ours)
    vision = component("rlvc vision", description="the C++ library that sees pictures", **ours)
    package = component("rlvc", ref="rlvc for Python", description="the Python package", **ours,
                        purl=PackageURL("pypi", name="rlvc", version=packing.VERSION))
    bom.register_dependency(core)
    bom.register_dependency(vision, [component(name, licence) for name, licence in VISION_NEEDS])
    needs = [core]
    for names, scope in zip(python_needs(), (ComponentScope.REQUIRED, ComponentScope.OPTIONAL), strict=True):
        needs += [component(name, scope=scope, purl=PackageURL("pypi", name=name.lower())) for name in sorted(names)]
    bom.register_dependency(package, needs)
    for archive in archives:
        digest = HashType(alg=HashAlgorithm.SHA_256, content=hashlib.sha256(archive.read_bytes()).hexdigest())
        component(archive.name, type=ComponentType.FILE, hashes=[digest])
    bom.metadata.component = Component(name="rlvc release", version=packing.VERSION, type=ComponentType.LIBRARY)
    bom.register_dependency(bom.metadata.component, [core, vision, package])
    bom.metadata.timestamp = None
    text = JsonV1Dot6(bom).output_as_string(indent=2) + "\n"
    fault = JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)
    if fault:
        raise packing.Failed(f"the bill of materials: {fault}")
    return text
