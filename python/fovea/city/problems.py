"""Errors of this package: each is one line that states what is wrong, where, and what to do."""
from __future__ import annotations

from ..errors import ConfigError, InputError, OutputError


def _line(what: str, where: object, remedy: str) -> str:
    return f"{what}, {where}, {remedy}"


def input_error(what: str, where: object, remedy: str) -> InputError:
    """The error of a file or folder that is missing or not of the expected form."""
    return InputError(_line(what, where, remedy))


def config_error(what: str, where: object, remedy: str) -> ConfigError:
    """The error of an option that is unknown or contradicts another one."""
    return ConfigError(_line(what, where, remedy))


def output_error(what: str, where: object, remedy: str) -> OutputError:
    """The error of an output that cannot be made."""
    return OutputError(_line(what, where, remedy))
