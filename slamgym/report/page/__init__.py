"""A report as one page that needs nothing but itself, and its figures and tables as files."""

from slamgym.report.page.write import check_report_folder, write_report

__all__ = ["check_report_folder", "write_report"]
