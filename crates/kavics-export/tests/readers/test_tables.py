"""The tables open in pandas, polars and DuckDB, as docs/results.md and docs/fracture.md show."""

import contextlib
import io
import os
import re
import unittest

import duckdb
import pandas
import polars

import runs

SNIPPET = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)


def snippets(page):
    text = (runs.ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    return SNIPPET.findall(text)


class Tables(unittest.TestCase):
    def test_every_snippet_of_the_pages_runs_and_two_of_them_agree(self):
        runs.stopped("disordered-block", "large")
        for scene in ["block-32", "stability", "fibre-bundle"]:
            runs.results(scene)
        before = os.getcwd()
        os.chdir(runs.PLACE)
        largest = []
        try:
            for snippet in snippets("results") + snippets("fracture"):
                names = {}
                printed = io.StringIO()
                with contextlib.redirect_stdout(printed):
                    exec(snippet, names)
                self.assertTrue(printed.getvalue())
                largest.append(names.get("largest"))
        finally:
            os.chdir(before)
        by_pandas, by_polars = (table for table in largest if table is not None)
        by_polars = by_polars.sort("step")
        self.assertEqual(by_pandas.index.tolist(), by_polars["step"].to_list())
        self.assertEqual(by_pandas.tolist(), by_polars["normal_force"].to_list())

    def test_all_three_read_the_same(self):
        folder = runs.results("dropped-1000")
        for name in ["steps", "events", "actions"]:
            path = str(folder / f"{name}.parquet")
            tables = [
                pandas.read_parquet(path),
                polars.read_parquet(path).to_pandas(),
                duckdb.sql(f"SELECT * FROM '{path}'").df(),
            ]
            for table in tables[1:]:
                self.assertEqual(list(table.columns), list(tables[0].columns))
                self.assertEqual(len(table), len(tables[0]))
                for column in table.columns:
                    both = zip(table[column], tables[0][column])
                    same = all(pandas.isna(b) if pandas.isna(a) else a == b for a, b in both)
                    self.assertTrue(same, f"{name}.{column}")
