"""The page in a real browser, with scripts as they are, and without any network."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from playwright.sync_api import expect, sync_playwright

from slamgym.report.content import DataTable, Picture, ReportContent, Section
from slamgym.report.page import write_report
from slamgym.study.results import StudyResults
from slamgym.study.table import open_study

CHROMIUM = Path("/usr/bin/chromium")
ARGUMENTS = [
    "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--no-first-run",
]  # fmt: skip
HOSTILE = [
    "<script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "{{7*7}}", "</script><b>x", "</template><i>y",
    "it's \"quoted\" & <!--", "back\u202egro\u200fund", "nul\x00bell\x07", "${alert(1)}", "javascript:alert(1)",
]  # fmt: skip

pytestmark = pytest.mark.skipif(not CHROMIUM.exists(), reason="needs Chromium")


@pytest.fixture(scope="session")
def browser():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture
def visit(browser):
    """A function that opens a page; whatever it says, asks for or fails at, fails the test."""
    told, contexts = [], []

    def open_page(path, **options):
        context = browser.new_context(**options)
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(60_000)
        address = path.resolve().as_uri()
        page.on("console", lambda message: told.append(f"console: {message.text}"))
        page.on("pageerror", lambda error: told.append(f"error: {error}"))
        page.on("dialog", lambda dialog: (told.append(f"dialog: {dialog.message}"), dialog.dismiss()))
        page.on("request", lambda request: told.append(request.url) if _is_foreign(request.url, address) else None)
        page.goto(address)
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert told == []


def _is_foreign(url, address):
    return not url.startswith("data:") and url.partition("#")[0] != address


@pytest.fixture(scope="module")
def report(results, tmp_path_factory):
    """The report of the study with four runs, without figures."""
    content = ReportContent("small", "Four backends.", {"paths": 1}, ("One of three fails.",), ())
    return write_report(content, results, tmp_path_factory.mktemp("report"))


def rows(page):
    """Texts of the runs that are shown."""
    return page.locator("#runs-table tbody tr").evaluate_all("all => all.map(tr => tr.innerText)")


def numbers(page):
    """Numbers of the runs that are shown."""
    return [int(text) for text in page.locator("#runs-table tbody th").all_inner_texts()]


def overflows(page):
    return page.evaluate("document.documentElement.scrollWidth > innerWidth")


def test_headings_sort_by_mouse_and_keyboard(report, visit):
    page = visit(report)
    heading = page.locator("#runs-table th", has_text="completion")
    assert numbers(page) == [1, 2, 3, 4]
    heading.get_by_role("button").click()
    # What could not be run has none, and stays last either way.
    assert numbers(page) == [3, 2, 1, 4]
    assert heading.get_attribute("aria-sort") == "ascending"
    page.keyboard.press("Enter")
    assert numbers(page) == [1, 2, 3, 4]
    assert heading.get_attribute("aria-sort") == "descending"
    page.locator("#runs-table th", has_text="run").first.get_by_role("button").click()
    page.keyboard.press("Enter")
    assert numbers(page) == [4, 3, 2, 1]


def test_search_and_choices_filter(report, visit):
    page = visit(report)
    page.get_by_label("Search").fill("losestwice PROCEDURAL")
    assert numbers(page) == [2]
    expect(page.locator("#count")).to_have_text("1 of 4 runs")
    page.get_by_label("Search").fill("home-7/3")
    assert numbers(page) == [3]
    page.get_by_label("Search").fill("")
    page.get_by_label("outcome").select_option("failed: crashed")
    assert numbers(page) == [3]
    page.get_by_label("SLAM").select_option("groundtruth")
    assert numbers(page) == []
    expect(page.locator("#count")).to_have_text("0 of 4 runs")


def test_failed_runs_are_marked_by_words(report, visit):
    page = visit(report)
    said = [next(word for word in ("success", "failed", "not run") if word in text) for text in rows(page)]
    assert said == ["success", "failed", "failed", "not run"]
    marked = page.locator("#runs-table tbody td:nth-child(3)").evaluate_all("all => all.map(td => td.className)")
    assert marked == ["success", "failed", "failed", ""]


def test_only_what_has_a_folder_can_be_repeated_from_it(results, visit, tmp_path):
    recorded = replace(results, runs=results.runs.assign(sequence=[None, "data/fr1", None, None]))
    page = visit(write_report(ReportContent("s", "", {}, (), ()), recorded, tmp_path))
    told = {}
    for number in (1, 2, 4):
        page.get_by_role("button", name=f"run {number}: details").click()
        body = page.locator("#run-body")
        told[number] = (body.get_by_role("link", name="Its folder").count(), body.locator("code").count())
        page.keyboard.press("Escape")
    assert told == {1: (1, 1), 2: (1, 0), 4: (0, 0)}


@pytest.mark.parametrize(("width", "seen"), [(390, "outcome"), (1280, "causes of losses")])
def test_what_a_run_came_to_needs_no_scrolling(width, seen, results, visit, tmp_path):
    many = ["multisampling_of_photogrammetrically_textured_houses", *(f"factor {k}" for k in range(8))]
    causes = {"loss_causes.low_texture": [0, 2, 1, 0], "loss_causes.frame_gap": [0, 1, 0, 0]}
    runs = results.runs.assign(**dict.fromkeys(many, range(4)), **causes)
    varied = replace(results, factors=tuple(many), runs=runs)
    page = visit(
        write_report(ReportContent("s", "", {}, (), ()), varied, tmp_path), viewport={"width": width, "height": 800}
    )
    box = page.locator("#runs-table .scroll").bounding_box()
    heading = page.locator("#runs-table thead th", has_text=seen).bounding_box()
    assert heading["x"] + heading["width"] <= box["x"] + box["width"]
    page.evaluate("document.querySelector('#runs-table .scroll').scrollLeft = 300")
    assert page.locator("#runs-table tbody th").first.bounding_box()["x"] == box["x"]
    texts = page.locator("#runs-table thead th")
    assert texts.evaluate_all("all => all.every(th => th.scrollWidth <= th.clientWidth)")


def test_a_run_opens_with_its_map_timeline_and_losses(report, results, visit):
    page = visit(report)
    page.get_by_role("button", name="run 2: details").focus()
    page.keyboard.press("Enter")
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("heading", name="Run 2")).to_be_visible()
    assert dialog.locator(".map polyline.truth").count() == 1
    assert dialog.locator(".map polyline.estimate").count() == 1
    assert dialog.locator(".map polyline.other").count() >= 1
    assert dialog.locator(".map .cross").count() == 2
    assert dialog.locator(".states rect.lost").count() == 2
    assert dialog.locator(".curve").count() == 3
    strips = dialog.locator(".losses img")
    expect(strips).to_have_count(2)
    assert strips.evaluate_all("all => all.every(image => image.complete && image.naturalWidth > 500)")
    assert dialog.locator(".losses li").first.inner_text().startswith("At 1.33 s:")
    command = dialog.locator("code").inner_text()
    assert command == f"slamgym run --like '{results.folder}/runs/home-7/2' --out again"
    page.get_by_role("button", name="Next run").click()
    expect(dialog.get_by_role("heading", name="Run 3")).to_be_visible()
    page.keyboard.press("Escape")
    expect(dialog).to_be_hidden()
    page.locator("#runs-table tbody td").first.click()
    expect(dialog.get_by_role("heading", name="Run 1")).to_be_visible()


def test_a_run_that_the_page_has_no_room_for_leads_to_its_folder(results, visit, tmp_path):
    elsewhere = replace(results, folder=tmp_path / "gone away")
    page = visit(write_report(ReportContent("s", "", {}, (), ()), elsewhere, tmp_path / "gone away"))
    page.get_by_role("button", name="run 1: details").click()
    link = page.get_by_role("dialog").get_by_role("link")
    assert link.get_attribute("href") == "runs/home-7/1/"
    assert "no room" in page.locator("#run-body").inner_text()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [360, 390, 1280])
def test_nothing_overflows(width, scheme, content, results, visit, tmp_path):
    wide = DataTable("wide", "Wide", "", pd.DataFrame({f"a long heading {k}": ["w" * 30] for k in range(20)}))
    name = replace(content, title="a" * 120, sections=(*content.sections, Section("w", "W", ("x" * 300,), (wide,))))
    page = visit(write_report(name, results, tmp_path), viewport={"width": width, "height": 800}, color_scheme=scheme)
    assert not overflows(page)
    for number in (2, 3, 4):
        page.get_by_role("button", name=f"run {number}: details").click()
        assert not overflows(page)
        assert page.evaluate("document.getElementById('run').scrollWidth <= document.getElementById('run').clientWidth")
        page.keyboard.press("Escape")


def test_pictures_are_shown(content, results, visit, tmp_path):
    page = visit(write_report(content, results, tmp_path))
    images = page.locator("main img")
    assert images.count() == 1
    assert images.evaluate_all("all => all.every(image => image.complete && image.naturalWidth > 500)")
    assert images.first.get_attribute("alt") == "How the sine goes."


def test_a_picture_opens_in_full_size(content, results, visit, tmp_path):
    page = visit(write_report(content, results, tmp_path), viewport={"width": 390, "height": 800})
    small = page.locator("main img").bounding_box()["width"]
    page.get_by_role("button", name="A wave: full size").click()
    full = page.get_by_role("dialog", name="A wave").get_by_role("img", name="How the sine goes.")
    assert full.bounding_box()["width"] > 1.3 * small
    assert not overflows(page)
    page.get_by_role("button", name="Close", exact=True).click()
    page.locator("main img").click()
    expect(full).to_be_visible()


def test_all_runs_are_on_paper(results, visit, tmp_path):
    runs = pd.concat([results.runs.iloc[:1]] * 1100, ignore_index=True)
    page = visit(write_report(ReportContent("s", "", {}, (), ()), replace(results, runs=runs), tmp_path))
    page.get_by_role("button", name="Next").click()
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert numbers(page) == list(range(1, 1001))
    expect(page.locator("#place")).to_have_text("Rows 1 to 1,000 of 1,100")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert numbers(page) == list(range(51, 101))


def test_print_shows_all_and_no_controls(report, visit):
    page = visit(report)
    page.emulate_media(media="print")
    for control in ("#filters", ".pages button", "nav[aria-label=Contents]"):
        assert page.locator(control).first.is_hidden()
    assert all(page.locator("#runs-table tbody tr").nth(row).is_visible() for row in range(4))


def test_without_scripts_the_runs_are_still_there(report, visit):
    page = visit(report, java_script_enabled=False)
    assert page.locator("noscript .runs tbody tr").count() == 4
    assert "failed: crashed" in page.locator("noscript").inner_text()
    assert page.locator("#filters").is_hidden()


def hostile_study(study_folder, folder):
    """Copied, with hostile words wherever words may be."""
    shutil.copytree(study_folder, folder)
    for file in folder.glob("runs/*/*/episode.json"):
        told = json.loads(file.read_text())
        told["failure"] = " ".join(HOSTILE)
        for loss in told["losses"]:
            loss["context"] = {"cause": HOSTILE[0], "explanation": HOSTILE[1]}
            loss["outcome"] = HOSTILE[2]
        file.write_text(json.dumps(told))
    runs = open_study(folder).runs
    runs = pd.concat([runs, runs.iloc[np.zeros(len(HOSTILE) - len(runs), dtype=int)]], ignore_index=True)
    runs.loc[4:, "run_id"] = [f"{word}/{word}" for word in HOSTILE[4:]]
    hostile = {"path": HOSTILE, "slam": HOSTILE, "dataset": HOSTILE, "status": HOSTILE, f"loss_causes.{HOSTILE[0]}": 1}
    return StudyResults(folder, HOSTILE[0], HOSTILE[1], ("slam",), len(runs) + 1, runs.assign(success=False, **hostile))


def test_hostile_names_are_text(study_folder, content, visit, tmp_path):
    results = hostile_study(study_folder, tmp_path / HOSTILE[1].replace("/", ""))
    frame = pd.DataFrame({HOSTILE[0]: HOSTILE, HOSTILE[1]: range(len(HOSTILE))})
    table = DataTable(HOSTILE[0], HOSTILE[0], HOSTILE[1], frame)
    picture = Picture(HOSTILE[1], HOSTILE[0], HOSTILE[1], content.sections[0].pictures[0].draw)
    section = Section("hostile", HOSTILE[3], tuple(HOSTILE), (table,), (picture,))
    facts = {word: word for word in HOSTILE}
    hostile = ReportContent(HOSTILE[0], HOSTILE[1], facts, tuple(HOSTILE), (section,))
    page = visit(write_report(hostile, results, results.folder))
    assert page.locator("h1").inner_text() == HOSTILE[0]
    assert page.title() == HOSTILE[0]
    shown = [word.replace("\u202e", "\ufffd").replace("\u200f", "\ufffd") for word in HOSTILE]
    shown = [word.replace("\x00", "\ufffd").replace("\x07", "\ufffd") for word in shown]
    assert page.locator(".headlines li").all_inner_texts() == shown
    assert page.locator("figure.table tbody td:first-child").all_inner_texts() == shown
    assert page.locator("#runs-table tbody td:nth-child(2)").all_inner_texts() == shown
    assert page.get_by_label("SLAM").locator("option").all_inner_texts()[1:] == sorted(shown)
    for number in range(1, len(HOSTILE) + 1):
        page.get_by_role("button", name=f"run {number}: details", exact=True).click()
        page.keyboard.press("Escape")
    page.get_by_role("button", name="run 2: details").click()
    body = page.locator("#run-body").inner_text()
    assert f"{HOSTILE[0]}." in body
    assert f"Given: {HOSTILE[1]}." in body
    assert page.locator("b, i, [onerror], body script:not([src]):not([type])").count() == 1


def test_a_hundred_thousand_runs(visit, tmp_path):
    n = 100_000
    rng = np.random.default_rng(1)
    speed = rng.choice([0.1, 0.4, 0.8, 1.6], n)
    ate = rng.permutation(n) / 1000
    runs = pd.DataFrame(
        {
            "run_id": [f"procedural-{k // 25}/{k % 25}" for k in range(n)],
            "drive_id": [f"procedural-{k // 25}" for k in range(n)],
            "path": [f"procedural:{k // 25} #1" for k in range(n)],
            "repeat": np.arange(n) % 5,
            "speed": speed,
            "status": np.where(speed > 1, "lost", "ok"),
            "success": speed <= 1,
            "loss_count": (speed > 1).astype(int),
            "completion": 1.0,
            "ate_rmse_m": ate,
            "loss_causes.blur": (speed > 1).astype(float),
        }
    )
    results = StudyResults(tmp_path, "huge", "", ("speed",), n, runs)
    path = write_report(ReportContent("huge", "", {}, (), ()), results, tmp_path)
    assert path.stat().st_size < 10_000_000
    page = visit(path)
    assert numbers(page) == list(range(1, 51))
    page.locator("#runs-table th", has_text="ATE").get_by_role("button").click()
    assert numbers(page) == (np.argsort(ate)[:50] + 1).tolist()
    page.get_by_label("speed").select_option("1.6")
    expect(page.locator("#count")).to_have_text(f"{np.sum(speed > 1):,} of 100,000 runs")
    page.get_by_role("button", name="Last").click()
    assert numbers(page)[-1] == np.argmax(np.where(speed > 1, ate, -1)) + 1
    page.get_by_label("Search").fill("procedural:123 blur")
    assert all("procedural:123" in text for text in rows(page))
