"""The paper's figures, from the tables in ../paper."""

import csv


class Paper:
    def __init__(self, folder):
        self.table1 = self.rows(folder / "table1.csv")
        self.table2 = {row["name"]: row for row in self.rows(folder / "table2.csv")}
        self.table3 = {row["name"]: row for row in self.rows(folder / "table3.csv")}
        self.published = {row["name"]: float(row["value"]) for row in self.rows(folder / "published.csv")}

    @staticmethod
    def rows(path):
        with open(path, newline="") as file:
            return list(csv.DictReader(file))

    def mrps(self, scene, chip):
        """Of Table 2; the generated forest stands in for the fairy forest. None where the paper has none."""
        column = {"conference": "conference", "crytek-sponza": "crytek", "dragon": "dragon", "forest": "fairy", "average": "average"}.get(scene)
        row = self.table2.get(chip)
        return float(row[f"{column}_mrps"]) if row and column else None
