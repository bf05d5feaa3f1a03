# SPDX-License-Identifier: MIT
"""Builds and runs tests/consumer in one of the ways that users have, or shows that a mistake is refused."""
import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
EXAMPLES = os.path.join(ROOT, "examples")


def call(command, **options):
    """Runs a command that must succeed; its output is the test's."""
    print("+", shlex.join(command), flush=True)
    return subprocess.run(command, check=True, **options)


def refused(command, expected, **options):
    """Runs a command that must fail and say `expected` (a regular expression) on its way."""
    print("+", shlex.join(command), flush=True)
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    # CMake breaks its messages into lines.
    said = re.search(expected, " ".join(result.stdout.split()))
    print(result.stdout)
    if result.returncode == 0 or not said:
        sys.exit(f"expected a failure that says: {expected}")


class Consumer:
    def __init__(self, args):
        self.args = args
        self.prefix = os.path.join(args.build, "tests", "installed")
        self.folder = os.path.join(args.build, "tests", "consumer_" + args.way)
        self.environment = dict(os.environ, PKG_CONFIG_PATH=os.path.join(
            self.prefix, args.libdir, "pkgconfig"))

    def configure(self, *options):
        shutil.rmtree(self.folder, ignore_errors=True)
        return [self.args.cmake, "-S", HERE, "-B", self.folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
                "-DCMAKE_CXX_FLAGS_DEBUG=",  # nobody looks for bugs in them
                f"-DCMAKE_CXX_COMPILER={self.args.cxx}", f"-DCMAKE_PREFIX_PATH={self.prefix}", *options]

    def build_and_run(self, *others):
        call([self.args.cmake, "--build", self.folder])
        for program in ("embed", "tower", "bullet_swap", "bullet_swap_float64", *others):
            call([os.path.join(self.folder, program)])

    def flags(self, package, kind):
        answer = subprocess.run(["pkg-config", kind, package], env=self.environment, check=True,
                                capture_output=True, text=True)
        return shlex.split(answer.stdout)

    def compile_command(self, example, package, program, *options):
        in_c = example.endswith(".c")
        compiler = [self.args.cc, "-std=c11"] if in_c else [self.args.cxx, "-std=c++20"]
        return [*compiler, *self.flags(package, "--cflags"), *options,
                os.path.join(EXAMPLES, example), "-o", os.path.join(self.folder, program),
                *self.flags(package, "--libs")]

    # The ways, by their names on the command line.

    def install(self):
        shutil.rmtree(self.prefix, ignore_errors=True)
        call([self.args.cmake, "--install", self.args.build, "--prefix", self.prefix],
             stdout=subprocess.DEVNULL)

    def find_package(self):
        call(self.configure("-DCONSUMER_COMPONENTS=Core;C;Lcp;Bullet;BulletFloat64"))
        self.build_and_run("engine", "mixed_lcp")

    def without_eigen(self):
        for components in ("Core;C;Bullet;BulletFloat64", ""):
            call(self.configure(f"-DCONSUMER_COMPONENTS={components}", "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON"))
        self.build_and_run()
        for package in ("cairn", "cairn-c", "cairn-bullet"):
            if "eigen" in " ".join(self.flags(package, "--cflags")):
                sys.exit(f"pkg-config: {package} asks for Eigen")

    def add_subdirectory(self):
        # What only our own tools and tests need must not be asked of a parent project.
        ours = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON"
                for name in ("CLI11", "fmt", "nlohmann_json", "GTest", "rapidcheck", "Python3")]
        call(self.configure(f"-DCONSUMER_CAIRN_SOURCE={ROOT}", *ours))
        self.build_and_run("engine", "mixed_lcp")

    def unoptimised(self):
        program = os.path.join(self.args.build, "tests", "consumer_add_subdirectory", "same_bits")
        call([program, "--gtest_filter=Determinism.HoldsFromMachineToMachine", "--gtest_brief=1"])

    def pkg_config(self):
        os.makedirs(self.folder, exist_ok=True)
        for example, package in (("embed.cc", "cairn"), ("tower.c", "cairn-c"), ("mixed_lcp.cc", "cairn-lcp"),
                                 ("bullet_swap.cc", "cairn-bullet"),
                                 ("bullet_swap.cc", "cairn-bullet-float64")):
            program = os.path.join(self.folder, package)
            call(self.compile_command(example, package, program))
            call([program], env=dict(os.environ, LD_LIBRARY_PATH=os.path.join(
                self.prefix, self.args.libdir)))

    def strict_hosts(self):
        # engines without exceptions and types at run time, and with every warning
        os.makedirs(self.folder, exist_ok=True)
        for example, package in (("embed.cc", "cairn"), ("tower.c", "cairn-c")):
            options = ["-Wall", "-Wextra", "-pedantic", "-Werror"]
            if example.endswith(".cc"):
                options += ["-fno-exceptions", "-fno-rtti"]
            program = os.path.join(self.folder, package)
            call(self.compile_command(example, package, program, *options))
            call([program], env=dict(os.environ, LD_LIBRARY_PATH=os.path.join(self.prefix, self.args.libdir)))

    def python(self):
        # as a script beside a game would
        if subprocess.run([sys.executable, "-c", "import numpy"], capture_output=True).returncode != 0:
            print("NumPy is missing, skipped")
            return
        library = os.path.join(self.prefix, self.args.libdir, "libcairn-c.so")
        script = os.path.join(EXAMPLES, "python", "error_against_sweeps.py")
        said = call([sys.executable, "-B", script, "--library", library], capture_output=True, text=True).stdout
        print(said)
        first, last = [[float(cell) for cell in line.split("|")] for line in said.splitlines()[1::11]]
        if not (last[0] == 100 and last[3] < 1e-3 * first[3] and last[2] < 0.1 * first[2]):
            sys.exit("a hundred sweeps leave as much error as one")

    def c_alone(self):
        # of a static Cairn, that is; a shared one brings its own libraries with it
        shutil.rmtree(self.folder, ignore_errors=True)
        call([self.args.cmake, "-S", os.path.join(HERE, "c"), "-B", self.folder, "-G", "Ninja",
              f"-DCMAKE_C_COMPILER={self.args.cc}", f"-DCMAKE_PREFIX_PATH={self.prefix}",
              "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON"])
        call([self.args.cmake, "--build", self.folder])
        for program in ("tower", "engine"):
            call([os.path.join(self.folder, program)])

    def mixed_precisions(self):
        refused(self.configure("-DCONSUMER_MIXES=ON"), "CAIRN_BULLET_PRECISION property of .*bullet3")

    def missing_component(self):
        refused(self.configure("-DCONSUMER_COMPONENTS=Bullet", "-DCMAKE_DISABLE_FIND_PACKAGE_CairnBullet=ON"),
                "cairn has no component Bullet: its Bullet was not found .*libbullet-dev")
        refused(self.configure("-DCONSUMER_COMPONENTS=Lcp", "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON"),
                "cairn has no component Lcp: Eigen 3.4 was not found .*libeigen3-dev")
        refused(self.configure("-DCONSUMER_COMPONENTS=Dynamics"),
                "cairn has no component Dynamics: there are only Core, C, Lcp, Bullet and BulletFloat64")

    def wrong_precision(self):
        os.makedirs(self.folder, exist_ok=True)
        refused(self.compile_command("bullet_swap.cc", "cairn-bullet", "a", "-DBT_USE_DOUBLE_PRECISION"),
                "undefined reference to .cairn::bullet::for_float64_bullet::ConstraintSolver",
                env=self.environment)
        refused(self.compile_command("bullet_swap.cc", "cairn-bullet-float64", "b", "-UBT_USE_DOUBLE_PRECISION"),
                "undefined reference to .cairn::bullet::for_float_bullet::ConstraintSolver",
                env=self.environment)


def main():
    ways = [name for name in vars(Consumer) if not name.startswith("_")]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("way", choices=ways)
    parser.add_argument("--build", required=True, help="the build folder of Cairn")
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("--cxx", default="g++")
    parser.add_argument("--cc", default="gcc")
    parser.add_argument("--libdir", default="lib", help="where libraries are, below the prefix")
    args = parser.parse_args()
    getattr(Consumer(args), args.way)()


if __name__ == "__main__":
    main()
