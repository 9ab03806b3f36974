import numpy as np
import pandas as pd

from slamgym.report.content import DataTable
from slamgym.report.page.tables import shown_value, write_table

FRAME = pd.DataFrame(
    {
        "name": ["50%_x & y", "a|b <b>*c*</b>", "=1+1"],
        "ATE (m)": [0.12345, np.nan, np.inf],
        "runs": [10, 2000, 3],
        "share": [0.5, None, 1.0],
    }
)
TABLE = DataTable("t", "T", "A table.", FRAME, {"ATE (m)": "{:.3f}", "runs": "{:,}", "share": "{:.0%}"})


def test_csv_has_the_values_as_they_are(tmp_path):
    write_table(TABLE, tmp_path)
    assert pd.read_csv(tmp_path / "tables" / "t.csv").equals(FRAME)


def test_markdown_is_escaped_and_aligned(tmp_path):
    write_table(TABLE, tmp_path)
    assert (tmp_path / "tables" / "t.md").read_text() == (
        "| name | ATE (m) | runs | share |\n"
        "| :--- | ---: | ---: | ---: |\n"
        "| 50%_x &amp; y | 0.123 | 10 | 50% |\n"
        "| a\\|b &lt;b&gt;\\*c\\*&lt;/b&gt; | - | 2,000 | - |\n"
        "| =1+1 | - | 3 | 100% |\n"
    )


def test_latex_is_a_booktabs_tabular_and_escaped(tmp_path):
    write_table(TABLE, tmp_path)
    lines = (tmp_path / "tables" / "t.tex").read_text().splitlines()
    assert lines[:2] == [r"\begin{tabular}{lrrr}", r"\toprule"]
    assert r"50\%\_x \& y & 0.123 & 10 & 50\% \\" in lines
    assert lines[-2:] == [r"\bottomrule", r"\end{tabular}"]


def test_the_page_knows_which_columns_are_numbers(tmp_path):
    table = write_table(TABLE, tmp_path)
    assert table.numeric == (False, True, True, True)
    assert table.rows[1] == ("a|b <b>*c*</b>", "-", "2,000", "-")


def test_control_characters_are_made_visible():
    assert shown_value("a\x00b\nc\u202ed") == "a\ufffdb c\ufffdd"
    assert shown_value(0.000123456) == "0.0001235"
    assert shown_value(float("nan")) == shown_value(None) == "-"
    assert shown_value(True) == "True"


def test_equal_headings_stay_apart(tmp_path):
    """They are the same once a control character is gone."""
    frame = pd.DataFrame({"a\x00": [1], "a\x01": ["x"]})
    table = write_table(DataTable("t", "T", "", frame), tmp_path)
    assert table.headings == ("a\ufffd", "a\ufffd")
    assert table.rows == (("1", "x"),)


def test_a_table_without_rows(tmp_path):
    table = write_table(DataTable("t", "T", "", pd.DataFrame({"a": [], "b": []})), tmp_path)
    assert (table.headings, table.rows) == (("a", "b"), ())
    assert (tmp_path / "tables" / "t.csv").read_text() == "a,b\n"
