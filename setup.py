"""Builds the Python module by CMake: `pip install .`, with --no-build-isolation from Debian's packages alone. The variable
CMAKE_ARGS may have further arguments of cmake."""
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py

ROOT = pathlib.Path(__file__).resolve().parent


class CleanBuild(build_py):
    """Modules that an earlier build has left would be installed with those of now."""

    def run(self):
        shutil.rmtree(pathlib.Path(self.build_lib) / "graze", ignore_errors=True)
        super().run()


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        build = pathlib.Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        settings = ["-DCMAKE_BUILD_TYPE=Release", "-DGRAZE_PYTHON=ON", "-DGRAZE_TESTS=OFF", "-DGRAZE_INSTALL=OFF",
                    "-DGRAZE_PAGE=OFF", "-DGRAZE_PRECOMPILED_HEADERS=ON", "-DGRAZE_TOGETHER=ON",
                    f"-DPython3_EXECUTABLE={sys.executable}"]
        settings += shlex.split(os.environ.get("CMAKE_ARGS", ""))
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", *settings], check=True)
        jobs = str(self.parallel or len(os.sched_getaffinity(0)))
        subprocess.run(["cmake", "--build", str(build), "--target", "graze_python", "--parallel", jobs], check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        (made,) = (build / "python/graze").glob("_graze*.so")
        self.copy_file(str(made), str(target))
        if shutil.which("strip"):
            subprocess.run(["strip", "--strip-unneeded", str(target)], check=True)


setup(ext_modules=[Extension("graze._graze", sources=[])], cmdclass={"build_ext": CMakeBuild, "build_py": CleanBuild})
