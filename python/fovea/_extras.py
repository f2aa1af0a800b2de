"""Packages that only some functions need."""
from __future__ import annotations

import importlib
from typing import Any


_PACKAGES = {"laz": '"laspy[lazrs]" copclib', "plot": "matplotlib"}


def load(module: str, extra: str) -> Any:
    """A module of an optional package. ImportError that names the packages to install."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        raise ImportError(
            f'{package} is missing or cannot be loaded ({error}): pip install {_PACKAGES[extra]}',
            name=module) from error
