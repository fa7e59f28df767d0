# SPDX-License-Identifier: MIT
"""The recipe for Conan 2, for the root of a source archive."""

import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Rlvc(ConanFile):
    name = "rlvc"
    license = "MIT"
    description = "Reinforcement learning of classes: a small decision tree, learnt from rewards in fixed memory"
    url = homepage = "https://example.org/rlvc"
    topics = ("reinforcement-learning", "decision-tree", "embedded", "control")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    implements = ["auto_shared_fpic"]
    languages = "C"
    exports_sources = "CMakeLists.txt", "LICENSE", "core/*", "vision/*"

    def set_version(self):
        text = load(self, f"{self.recipe_folder}/CMakeLists.txt")
        self.version = re.search(r"project\(rlvc VERSION (\S+)", text)[1]

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for name in ("RLVC_VISION", "RLVC_TOOLS", "RLVC_EXAMPLES"):
            toolchain.cache_variables[name] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, f"{self.package_folder}/licenses")
        CMake(self).install()

    def package_info(self):
        self.cpp_info.libs = ["rlvc"]
        self.cpp_info.cflags = self.cpp_info.cxxflags = ["-ffp-contract=off"]
        self.cpp_info.set_property("cmake_target_name", "rlvc::rlvc")
