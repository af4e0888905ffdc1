"""Marks a wheel that contains the extension module as one for this platform and Python.

pyproject.toml has everything else. The module is built by CMake and not by setuptools: it is part of
the package's folder if scripts/build_python.sh has put it there.
"""

import pathlib

import setuptools

PACKAGE = pathlib.Path(__file__).parent / "duet_motion"


class Distribution(setuptools.Distribution):
    def has_ext_modules(self):
        return any(PACKAGE.glob("_motion_files.*.so"))


setuptools.setup(distclass=Distribution)
