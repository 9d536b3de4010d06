"""The paper's published figures (../paper)."""

import csv
import pathlib

from trax_eval.util import Problem

from .results import ratio


class Published(float):
    """A figure with the digits that the paper prints."""
    def __new__(cls, text):
        made = super().__new__(cls, text)
        made.text = text.strip()
        return made


class Paper:
    """The tables of the paper, by chip; the numbers are those of its text."""
    def __init__(self, directory):
        directory = pathlib.Path(directory)
        self.table1 = self._rows(directory / "table1.csv", "area_mm2")
        self.table2 = {row["name"]: row for row in self._rows(directory / "table2.csv", "average_mrps")}
        self.table3 = {row["name"]: row for row in self._rows(directory / "table3.csv", "dragon_16gbs_mrps")}
        self.chips = list(self.table2)
        published = directory / "published.csv"
        self.published = {}
        if published.exists():
            self.published = {row["name"]: row["value"] for row in self._rows(published, "value")}

    @staticmethod
    def _rows(path, needed):
        try:
            with open(path, encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
        except (OSError, UnicodeDecodeError) as error:
            raise Problem(f"{path}: cannot be read: {error}") from None
        if not rows or needed not in rows[0] or "name" not in rows[0]:
            raise Problem(f"{path}: has no column \"{needed}\"")
        for line, row in enumerate(rows, 2):
            for key, value in row.items():
                if key in ("name", "unit", "place", "what", "where"):
                    continue
                try:
                    row[key] = Published(value) if value and value.strip() else None
                except (TypeError, ValueError):
                    raise Problem(f"{path}:{line}: {key}: \"{value}\" is no number") from None
        return rows

    def threads(self, chip):
        row = self.table2[chip]
        return int(row["tms"] * row["tps_per_tm"])

    def mrps(self, column, chip):
        """A rate of Table 2; "average" is the paper's own average."""
        row = self.table2.get(chip)
        return row.get(f"{column}_mrps") if row else None

    def speedup(self, column, chip):
        return ratio(self.mrps(column, chip), self.mrps(column, "1x32"))
