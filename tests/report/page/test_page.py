import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pandas as pd
import pytest

from slamgym.errors import OutputError
from slamgym.eval.plots.style import new_figure
from slamgym.report.content import Picture, Section
from slamgym.report.page import write_report

FILES = {
    "report.html", "figures/wave.svg", "figures/wave.png", "tables/by_backend.csv", "tables/by_backend.tex",
    "tables/by_backend.md", ".report_files",
}  # fmt: skip


def files(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


class Addresses(HTMLParser):
    """All that a page would load or lead to."""

    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attrs):
        self.found += [(tag, value) for name, value in attrs if name in ("src", "href", "srcset", "data", "action")]


def test_the_report_is_a_page_its_figures_and_its_tables(content, results, tmp_path):
    page = write_report(content, results, tmp_path / "deep" / "report")
    assert page == tmp_path / "deep" / "report" / "report.html"
    assert files(page.parent) == FILES
    text = page.read_text()
    for said in (
        content.title,
        content.description,
        *content.headlines,
        "One sentence.",
        "0.123",
        "How the sine goes.",
    ):
        assert said in text


def test_the_page_needs_nothing_but_itself(content, results, tmp_path):
    text = write_report(content, results, tmp_path).read_text()
    parser = Addresses()
    parser.feed(text)
    assert len(parser.found) > 5
    assert all(re.match(r"data:|#", address) for _, address in parser.found)
    assert "default-src 'none'" in text
    assert "url(" not in text
    assert "@import" not in text


def test_a_report_written_again_is_the_same(content, results, study_folder, tmp_path):
    first = write_report(content, results, tmp_path).read_text()
    assert write_report(content, results, tmp_path).read_text() == first
    assert files(tmp_path) == FILES


def test_what_is_no_longer_drawn_goes_away_and_nothing_else(content, results, tmp_path):
    write_report(content, results, tmp_path)
    (tmp_path / "figures" / "mine.svg").write_text("mine")
    write_report(replace(content, sections=()), results, tmp_path)
    assert files(tmp_path) == {"report.html", ".report_files", "figures/mine.svg"}


def test_a_list_of_files_that_somebody_changed_removes_nothing_else(content, results, tmp_path):
    folder = tmp_path / "report"
    write_report(content, results, folder)
    kept = [tmp_path / "kept.svg", folder / "figures" / "kept.txt", folder / "kept.png"]
    for file in kept:
        file.write_text("mine")
    lines = "figures/../../kept.svg\n../kept.svg\nfigures/kept.txt\nkept.png\n" + f"{kept[0]}\n"
    (folder / ".report_files").write_text(lines)
    write_report(replace(content, sections=()), results, folder)
    assert all(file.read_text() == "mine" for file in kept)


def test_names_of_pictures_stay_in_their_folder(content, results, tmp_path):
    picture = Picture("../../up/../x y", "Up", "Up.", content.sections[0].pictures[0].draw)
    write_report(replace(content, sections=(Section("s", "S", pictures=(picture,)),)), results, tmp_path / "report")
    assert files(tmp_path) == {
        f"report/{name}"
        for name in ("report.html", ".report_files", "figures/.._.._up_.._x_y.svg", "figures/.._.._up_.._x_y.png")
    }


def test_a_picture_of_many_points_is_an_image(content, results, tmp_path):
    def cloud():
        figure = new_figure(7, 3)
        figure.add_subplot().plot(np.random.default_rng(0).normal(size=(9000, 2)), ".")
        return figure

    picture = Picture("cloud", "Cloud", "Many.", cloud)
    text = write_report(
        replace(content, sections=(Section("s", "S", pictures=(picture,)),)), results, tmp_path
    ).read_text()
    assert (tmp_path / "figures" / "cloud.svg").stat().st_size > 500_000
    assert '<img src="data:image/png' in text
    assert '<img src="data:image/svg' not in text
    assert len(text) < 1_000_000


def test_a_long_table_is_cut_in_the_page_only(content, results, tmp_path):
    table = replace(content.sections[0].tables[0], frame=pd.DataFrame({"n": range(1000)}), formats={})
    page = write_report(replace(content, sections=(Section("s", "S", tables=(table,)),)), results, tmp_path)
    text = page.read_text()
    assert "The first 200 of 1,000 rows" in text
    assert '<td class="number">199</td>' in text
    assert '<td class="number">200</td>' not in text
    assert len(pd.read_csv(tmp_path / "tables" / "by_backend.csv")) == 1000


def test_a_study_without_any_run(content, results, tmp_path):
    text = write_report(content, replace(results, runs=results.runs.iloc[:0]), tmp_path).read_text()
    assert "The first 0 of 0 runs" in text


def test_links_lead_from_another_folder_to_the_runs(content, results, tmp_path):
    text = write_report(content, results, tmp_path).read_text()
    (url,) = re.findall(r'"runs_url": "([^"]*)"', text)
    assert url.endswith("small%20study/runs/")
    assert (tmp_path / url.replace("%20", " ")).resolve() == (results.folder / "runs").resolve()


@pytest.mark.parametrize("name", ["report", "report/figures"])
def test_a_file_in_the_way_is_one_clear_error(name, content, results, tmp_path):
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    with pytest.raises(
        OutputError, match=r"expected a folder for the report, got a file|cannot write|writing .* failed"
    ):
        write_report(content, results, tmp_path / "report")
    assert (tmp_path / name).read_text() == "mine"


@pytest.mark.parametrize("file", ["plan.json", "study.yaml"])
def test_the_report_of_another_study_is_not_replaced(file, content, results, tmp_path):
    (tmp_path / file).write_text("theirs")
    with pytest.raises(OutputError, match="got that of another study; name another"):
        write_report(content, results, tmp_path)
    assert files(tmp_path) == {file}
    assert write_report(content, replace(results, folder=tmp_path / "x" / ".."), tmp_path).exists()


def test_what_one_must_know_comes_before_what_the_data_say(content, results, tmp_path):
    text = write_report(replace(content, notices=("Not <finished>.",)), results, tmp_path).read_text()
    assert text.index("Not &lt;finished&gt;.") < text.index(content.headlines[0])
    assert text.count("Not &lt;finished&gt;.") == 1
