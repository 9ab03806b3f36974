"""Writes the report of a study."""

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from slamgym.errors import OutputError
from slamgym.files import write_atomically
from slamgym.report.content import ReportContent, Section
from slamgym.report.page.details import details, runs_url
from slamgym.report.page.file_names import announce, remove_others
from slamgym.report.page.pictures import PagePicture, picture_files, write_picture
from slamgym.report.page.run_columns import run_columns, runs_data
from slamgym.report.page.tables import PageTable, shown_value, table_files, write_table
from slamgym.report.page.templates import filled, inlined
from slamgym.study.folder import StudyFolder
from slamgym.study.results import StudyResults

PAGE = "report.html"
ROWS_WITHOUT_SCRIPT = 50


@dataclass(frozen=True, slots=True)
class PageSection:
    """A section with its tables and pictures as the page has them."""

    anchor: str
    title: str
    sentences: tuple[str, ...]
    tables: tuple[PageTable, ...]
    pictures: tuple[PagePicture, ...]


def write_report(content: ReportContent, results: StudyResults, folder: Path) -> Path:
    """Write `report.html`, which needs nothing but itself, and its figures and tables as files; return its path.

    figures/NAME.svg, .png  each picture
    tables/NAME.csv         each table with its values as they are
    tables/NAME.tex, .md    the same as the page has it

    results: those that the content is about; their runs are in the page's table, with as much about single runs as
    there is room for. Each file is whole or as it was; a report that was there before is replaced. Raises OutputError,
    also for a folder of another study, whose own report it would replace.
    """
    check_report_folder(folder, results)
    files = list(_files(content))
    announce(folder, files)
    sections = [_written(section, folder) for section in content.sections]
    page = write_atomically(folder / PAGE, _page(content, sections, results, folder))
    remove_others(folder, files)
    return page


def check_report_folder(folder: Path, results: StudyResults) -> None:
    """Raise OutputError where `write_report` would: for a file, and the folder of another study. It may be missing."""
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder}: expected a folder for the report, got a file; name another")
    place = StudyFolder(folder)
    if folder.resolve() != results.folder.resolve() and (place.plan.exists() or place.study.exists()):
        raise OutputError(
            f"{folder}: expected a folder for the report of {results.folder}, got that of another study; name another"
        )


def _files(content: ReportContent) -> Iterator[str]:
    for section in content.sections:
        for table in section.tables:
            yield from table_files(table)
        for picture in section.pictures:
            yield from picture_files(picture)


def _written(section: Section, folder: Path) -> PageSection:
    return PageSection(
        section.anchor,
        section.title,
        section.sentences,
        tuple(write_table(table, folder) for table in section.tables),
        tuple(write_picture(picture, folder) for picture in section.pictures),
    )


def _page(content: ReportContent, sections: list[PageSection], results: StudyResults, folder: Path) -> str:
    columns = run_columns(results)
    first_rows = range(min(ROWS_WITHOUT_SCRIPT, len(results.runs)))
    data = {
        **runs_data(results.runs, columns),
        "runs_url": runs_url(results, folder),
        "runs_folder": f"{results.folder}/runs/",
    }
    return filled(
        "report.html",
        content=content,
        facts={label: shown_value(value) for label, value in content.facts.items()},
        sections=sections,
        results=results,
        columns=columns,
        first_rows=[[column.shown(row) for column in columns] for row in first_rows],
        data=data,
        details=details(results, folder),
        version=version("slamgym"),
        **inlined(),
    )
