"""The two files that every run folder has: what was asked for, `config.yaml`, and the results, `episode.json`."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import yaml

from slamgym.errors import ConfigError
from slamgym.eval.summary import without_nan

CONFIG, RESULTS = "config.yaml", "episode.json"


def write_record(folder: Path, config: Mapping[str, Any], results: Mapping[str, Any]) -> None:
    """Raises OSError."""
    # Through JSON: a user may have given paths or NumPy's numbers, which YAML cannot write.
    plain = json.loads(json.dumps(config, default=str))
    (folder / CONFIG).write_text(yaml.safe_dump(plain, sort_keys=False))
    (folder / RESULTS).write_text(json.dumps(without_nan(results), indent=2, allow_nan=False) + "\n")


def read_config(folder: Path, advice: str) -> dict[str, Any]:
    """The parameters of a run. Raises ConfigError, which ends with the advice, where they cannot be read."""
    # libyaml reads many times as fast as PyYAML's own reader.
    return _read(folder, CONFIG, lambda text: yaml.load(text, yaml.CSafeLoader), advice)


def read_results(folder: Path, advice: str) -> dict[str, Any]:
    """The results of a run; raises as `read_config` does."""
    return _read(folder, RESULTS, json.loads, advice)


def _read(folder: Path, name: str, parse: Callable[[str], Any], advice: str) -> dict[str, Any]:
    try:
        content = parse((folder / name).read_text(encoding="utf-8"))
    except OSError:
        raise _not_a_run(folder, f"one whose {name} cannot be read", advice) from None
    except (ValueError, yaml.YAMLError) as error:
        what = f"{type(error).__name__}: {error}".splitlines()[0]
        raise _not_a_run(folder, f"a damaged {name} ({what})", advice) from None
    if not isinstance(content, dict):
        raise _not_a_run(folder, f"a {name} that is {content!r:.40}", advice)
    return content


def _not_a_run(folder: Path, got: str, advice: str) -> ConfigError:
    return ConfigError(f"{folder}: expected the folder of a run, got {got}; {advice}")
