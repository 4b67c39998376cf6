"""`pip install .`: builds the library behind the Python module by CMake, as CMakeLists.txt does, and packs it with the
materials. Debian 12 has no scikit-build-core; setuptools calling CMake needs nothing that Debian lacks."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent
PACKAGE = 'src/scintray/python/scintray'


def version():
    return re.search(r'project\(ScintRay VERSION ([0-9.]+)', (SOURCE / 'CMakeLists.txt').read_text()).group(1)


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        package = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        build = SOURCE / 'build' / 'pip'
        subprocess.run(['cmake', '--preset', 'release', '-B', build, '-DSCINTRAY_TESTS=OFF', '-DSCINTRAY_PYTHON=ON',
                        '-DSCINTRAY_PYTHON_DESTINATION=.', f'-DPython_EXECUTABLE={sys.executable}'],
                       cwd=SOURCE, check=True)
        jobs = os.environ.get('CMAKE_BUILD_PARALLEL_LEVEL', str(os.cpu_count() or 1))
        subprocess.run(['cmake', '--build', build, '--target', 'scintray_python', '-j', jobs], check=True)
        package.mkdir(parents=True, exist_ok=True)
        for library in (build / 'python' / 'scintray').glob('_core.*.so'):
            shutil.copy(library, package)
            subprocess.run(['strip', '--strip-unneeded', package / library.name], check=True)
        # The data that the program finds beside itself, the module finds in its package.
        for folder in ('materials', 'scenes', 'geometry'):
            shutil.copytree(SOURCE / folder, package / 'data' / folder, dirs_exist_ok=True)


setup(
    version=version(),
    packages=['scintray'],
    package_dir={'scintray': PACKAGE},
    package_data={'scintray': ['py.typed', '*.pyi']},
    ext_modules=[Extension('scintray._core', [])],
    cmdclass={'build_ext': BuildByCMake},
    zip_safe=False,
)
