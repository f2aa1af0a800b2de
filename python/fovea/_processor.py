"""Whether this processor can run the compiled module: otherwise the import would end Python without a word."""
from __future__ import annotations

import pathlib


def missing_feature(needed: list[str], processor: str) -> str | None:
    """The first of `needed` that `processor` lacks, the text of /proc/cpuinfo. None without a list of features."""
    for line in processor.splitlines():
        if line.startswith("flags"):
            features = line.split()
            return next((each for each in needed if each not in features), None)
    return None


def check() -> None:
    """ImportError if this processor lacks a feature that the build targets."""
    needed = pathlib.Path(__file__).with_name("processor.txt").read_text(encoding="ascii").split()
    try:
        processor = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return
    missing = missing_feature(needed, processor)
    if missing is not None:
        raise ImportError(f"fovea: the processor lacks {missing}, this machine, use a processor with x86-64-v3 "
                          "(from 2013 on) or build Fovea with -DFOVEA_X86_64_V3=OFF")


check()
