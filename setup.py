"""Builds the Python module by CMake: `pip install .`, with --no-build-isolation from Debian's packages alone."""
import os
import pathlib
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        build = pathlib.Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        settings = ["-DCMAKE_BUILD_TYPE=Release", "-DGRAZE_PYTHON=ON", "-DGRAZE_TESTS=OFF", "-DGRAZE_INSTALL=OFF",
                    "-DGRAZE_PRECOMPILED_HEADERS=ON", "-DGRAZE_TOGETHER=ON", f"-DPython3_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", *settings], check=True)
        jobs = str(self.parallel or len(os.sched_getaffinity(0)))
        subprocess.run(["cmake", "--build", str(build), "--target", "graze_python", "--parallel", jobs], check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        (made,) = (build / "python/graze").glob("_graze*.so")
        self.copy_file(str(made), str(target))


setup(ext_modules=[Extension("graze._graze", sources=[])], cmdclass={"build_ext": CMakeBuild})
