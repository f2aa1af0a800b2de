"""Errors of Fovea. Each is one line: what is wrong, where, and what to do."""


class Error(RuntimeError):
    """Base of every error."""

    problem: str
    where: str
    remedy: str


class InputError(Error):
    """A file or folder that was read is missing, damaged or not of the expected form."""


class ConfigError(Error):
    """An option or configuration key is unknown, of the wrong type or out of range."""


class OutputError(Error):
    """An output cannot be written: it exists, its folder does not, or the disk is full."""
