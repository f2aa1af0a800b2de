"""Chooses the pairs of maps to align. Their number grows linearly with the maps, also where many repeat a street.

Each path covers cells of 10 m on the ground: those within 15 m and the allowance for its navigation. Two maps in one
cell are near: their paths come within 30 m and both allowances, or a little more. The allowance is 5 m and three sigma.
A drive that is near no other one gets an allowance of 25 m instead of 5 m: `fovea align` finds maps that far off.

In each cell a map gets at most 8 partners. With more maps than that, their order by name is random, so partners 1, 2, 4
and 8 places away in it are spread over drives and days, and the graph of pairs is connected.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence

from .drives import Segment
from .ground import Cell, Point, cells_within

CELL_M = 10.0
REACH_M = 15.0  # half the distance of two paths that are a pair
ALLOWANCE_M = 5.0
WIDE_ALLOWANCE_M = 25.0
SIGMAS = 3.0
MOST_PARTNERS = 8  # of a map in a cell

Pair = tuple[int, int]  # numbers of segments, the lower one first


def allowance_of(segment: Segment, base: float = ALLOWANCE_M) -> float:
    """m by which navigation may be off."""
    return base + SIGMAS * segment.drive.accuracy_m


def choose_pairs(segments: Sequence[Segment], paths: Sequence[Sequence[Point]]) -> list[Pair]:
    """Pairs of segments, sorted. Segments are in the order of their names. Two that are placed are no pair.

    @param paths  of the segments, in the plane, a point each 5 m
    """
    covered = [_cells_of(path, allowance_of(segment)) for segment, path in zip(segments, paths)]
    pairs = _Choice(segments, covered).pairs()
    lonely = lonely_drives(segments, pairs)
    if not lonely:
        return sorted(pairs)
    for number, segment in enumerate(segments):
        if segment.drive.digest in lonely:
            covered[number] = _cells_of(paths[number], allowance_of(segment, WIDE_ALLOWANCE_M))
    return sorted(_Choice(segments, covered).pairs())


def lonely_drives(segments: Sequence[Segment], pairs: Iterable[Pair]) -> set[str]:
    """Digests of new drives that have no pair with another drive."""
    lonely = {segment.drive.digest for segment in segments if segment.placed_by is None}
    for a, b in pairs:
        first, second = segments[a].drive.digest, segments[b].drive.digest
        if first != second:
            lonely -= {first, second}
    return lonely


def _cells_of(path: Sequence[Point], allowance: float) -> set[Cell]:
    cells: set[Cell] = set()
    for x, y in (*path[::2], *path[-1:]):  # each 10 m
        cells.update(cells_within(x, y, REACH_M + allowance, CELL_M))
    return cells


class _Choice:
    """The pairs of segments that cover common cells."""

    def __init__(self, segments: Sequence[Segment], covered: list[set[Cell]]) -> None:
        self.segments, self.covered = segments, covered
        self._chosen: set[Pair] = set()
        self._closed: set[Pair] = set()  # has its partners in some cell
        self._partners: dict[tuple[Cell, int], int] = {}
        self._group = list(range(len(self.segments)))  # of segments that pairs connect: a union-find forest
        self._in_cell: dict[Cell, list[int]] = {}
        for number, cells in enumerate(self.covered):
            for cell in cells:
                self._in_cell.setdefault(cell, []).append(number)

    def pairs(self) -> set[Pair]:
        self._join_placed()
        self._add_sections_that_follow()
        lists = [self._in_cell[cell] for cell in sorted(self._in_cell)]
        for numbers in lists:  # first what connects the graph
            for a, b in zip(numbers, numbers[1:]):
                if self._root(a) != self._root(b):
                    self._add(a, b)
        for numbers in lists:
            for step in _steps(len(numbers)):
                for a, b in zip(numbers, numbers[step:]):
                    if self._is_open(a, b):
                        self._add(a, b)
        return self._chosen

    def _join_placed(self) -> None:
        placed = [number for number, segment in enumerate(self.segments) if segment.placed_by is not None]
        for number in placed:
            self._group[number] = placed[0]

    def _add_sections_that_follow(self) -> None:
        by_begin = sorted(range(len(self.segments)),
                          key=lambda number: (self.segments[number].drive.digest, self.segments[number].begin))
        for a, b in zip(by_begin, by_begin[1:]):
            first, second = self.segments[a], self.segments[b]
            if first.drive.digest == second.drive.digest and second.begin < first.end and not self._is_fixed(a, b):
                self._add(*sorted((a, b)))

    def _is_fixed(self, a: int, b: int) -> bool:
        return self.segments[a].placed_by is not None and self.segments[b].placed_by is not None

    def _is_open(self, a: int, b: int) -> bool:
        if (a, b) in self._chosen or (a, b) in self._closed or self._is_fixed(a, b):
            return False
        is_open = all(self._partners.get((cell, number), 0) < MOST_PARTNERS
                      for cell in self.covered[a] & self.covered[b] for number in (a, b))
        if not is_open:
            self._closed.add((a, b))
        return is_open

    def _add(self, a: int, b: int) -> None:
        self._chosen.add((a, b))
        self._group[self._root(a)] = self._root(b)
        for cell in self.covered[a] & self.covered[b]:
            for number in (a, b):
                self._partners[cell, number] = self._partners.get((cell, number), 0) + 1

    def _root(self, number: int) -> int:
        while self._group[number] != number:
            self._group[number] = self._group[self._group[number]]
            number = self._group[number]
        return number


def _steps(count: int) -> Iterable[int]:
    """Distances in an order of `count` maps: all, or powers of two where that would be too many."""
    if count <= MOST_PARTNERS + 1:
        return range(1, count)
    return [1 << bit for bit in range(count.bit_length()) if 1 << bit < count]
