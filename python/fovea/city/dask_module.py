"""The module of Dask Distributed."""
from __future__ import annotations

import importlib
import logging
from typing import Any

from .problems import config_error


def dask_module() -> Any:
    """Imports `distributed` when jobs run: it takes a second. ConfigError if it is not installed."""
    try:
        module = importlib.import_module("distributed")
    except ImportError as error:
        raise config_error(f"Dask Distributed is missing ({error})", "this Python",
                           "install python3-distributed, and run /usr/bin/python3") from error
    for name in ("", "distributed", "distributed.client"):  # the import sets their levels; the build reports errors
        logging.getLogger(name).setLevel(logging.CRITICAL)
    return module
