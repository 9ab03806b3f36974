"""The studies that come with slamgym, by name."""

from importlib.resources import files
from pathlib import Path

from slamgym.errors import ConfigError, unknown_word

SUFFIXES = (".yaml", ".yml")


def shipped_studies() -> dict[str, Path]:
    """Name -> file. A new one is one file in `eval/studies`."""
    folder = Path(str(files("slamgym.eval.studies")))
    return {path.stem: path for path in sorted(folder.glob("*.yaml"))}


def find_study(path_or_name: Path | str) -> Path:
    """The file of a shipped study's name, which goes before, or of a path; raises ConfigError."""
    shipped, path = shipped_studies(), Path(path_or_name).expanduser()
    if str(path_or_name) in shipped:
        return shipped[str(path_or_name)]
    if path.is_dir():
        raise ConfigError(f"{path}: expected the yaml file of a study, got a folder; name the file in it")
    if path.is_file():
        return path
    if path.suffix in SUFFIXES or len(path.parts) > 1:
        raise ConfigError(f"{path}: expected the yaml file of a study, got none there; check the path")
    raise ConfigError(unknown_word("study", str(path_or_name), shipped) + "; or give the yaml file of your own")
