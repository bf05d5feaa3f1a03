# SPDX-License-Identifier: MIT
"""Recipe of Cairn for Conan 2, of this folder of sources: conan create packaging/conan"""
import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir

required_conan_version = ">=2.0"


class Cairn(ConanFile):
    name = "cairn"
    version = "0.2.0"
    description = "Constraint solver for game physics: fast sweeps, subspace steps, a frame budget"
    license = "MIT"
    topics = ("physics", "game", "solver", "bullet")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False], "bullet": [True, False],
               "bullet_double": [True, False], "tbb": [True, False]}
    default_options = {"shared": False, "fPIC": True, "bullet": False, "bullet_double": False, "tbb": True}

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "THIRD_PARTY.md", "cmake/*", "core/*", "simd/*", "bullet_adapter/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def config_options(self):
        if self.settings.os == "Windows":
            del self.options.fPIC

    def configure(self):
        if self.options.shared:
            self.options.rm_safe("fPIC")
        if self.options.bullet:
            self.options["bullet3"].double_precision = self.options.bullet_double

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("eigen/3.4.0", transitive_headers=True)
        self.requires("highway/1.0.3")
        if self.options.tbb:
            self.requires("onetbb/2021.10.0")
        if self.options.bullet:
            self.requires("bullet3/3.25", transitive_headers=True, transitive_libs=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def _bullet(self):
        if not self.options.bullet:
            return "off"
        return "float64" if self.options.bullet_double else "float"

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables.update({
            "CAIRN_BULLET": self._bullet(), "CAIRN_TBB": bool(self.options.tbb), "CAIRN_TOOLS": False,
            "CAIRN_TESTS": False, "CAIRN_EXAMPLES": False})
        if self.options.bullet:
            toolchain.cache_variables["Bullet_ROOT"] = self.dependencies["bullet3"].package_folder
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        for folder in ("cmake", "pkgconfig"):
            rmdir(self, os.path.join(self.package_folder, "lib", folder))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "cairn")
        core = self.cpp_info.components["core"]
        core.set_property("cmake_target_name", "cairn::cairn")
        core.libs = ["cairn"]
        core.requires = ["highway::hwy"] + (["onetbb::libtbb"] if self.options.tbb else [])
        if self.settings.os in ("Linux", "FreeBSD"):
            core.system_libs = ["m", "pthread"]
        names = {"lcp": "lcp", "c": "c"}
        if self.options.bullet:
            names["bullet"] = "bullet-float64" if self.options.bullet_double else "bullet"
        for component, name in names.items():
            part = self.cpp_info.components[component]
            part.set_property("cmake_target_name", f"cairn::{name}")
            part.libs = [f"cairn-{name}"]
            part.requires = ["core"] + {"bullet": ["bullet3::bullet3"], "lcp": ["eigen::eigen"]}.get(component, [])
            if name == "bullet-float64":
                part.defines = ["BT_USE_DOUBLE_PRECISION"]
