"""`slamgym vocab`: the vocabularies that ORB-SLAM recognises places by."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Annotated

import tyro

from slamgym.cli.terminal import notes, printing, progress_bar, results, say, working
from slamgym.errors import ConfigError
from slamgym.files import check_free, write_atomically
from slamgym.slam.fetch_vocabulary import ORBVOC, Source, fetch_vocabulary, fetched_vocabulary
from slamgym.slam.train_vocabulary import (
    FEATURES,
    IMAGES_PER_HOUSE,
    TRAINING_SEEDS,
    house_descriptors,
    image_descriptors,
    image_files,
    read_image,
)
from slamgym.slam.vocabulary import vocabulary_path
from slamgym.slam.vocabulary_file import Descriptors, Vocabulary, vocabulary_info
from slamgym.slam.vocabulary_tree import check_shape, train

_NAMED_FILES = 5


@dataclass(kw_only=True)
class Train:
    """Train a vocabulary: on rendered houses, or on a folder of images.

    Example: slamgym vocab train --images rgbd_dataset_freiburg1_room/rgb --out room.txt
    """

    out: Path
    """Text file to write; it must not exist yet, or be empty."""
    images: Annotated[
        Path | None,
        tyro.conf.arg(
            metavar="FOLDER", help="PNG and JPEG images, searched for recursively; folders named depth are left out"
        ),
    ] = None
    max_images: Annotated[int, tyro.conf.arg(help="images taken from the folder, evenly spread over all")] = 300
    seeds: Annotated[
        tuple[int, ...] | None,
        tyro.conf.arg(
            metavar="SEED...", help=f"procedural houses; None: {len(TRAINING_SEEDS)} that are reserved for training"
        ),
    ] = None
    images_per_house: Annotated[int, tyro.conf.arg(help="images rendered of each house")] = IMAGES_PER_HOUSE
    features: Annotated[int, tyro.conf.arg(help="ORB features an image")] = FEATURES
    branching: Annotated[int, tyro.conf.arg(help="children of a node")] = 6
    depth: Annotated[int, tyro.conf.arg(help="levels of the tree; ORB-SLAM needs 6 to compare images well")] = 6
    seed: Annotated[int, tyro.conf.arg(help="of the clustering: same images and seed, same vocabulary")] = 0

    def __call__(self) -> None:
        self._check()
        check_free(self.out, "file")
        start = perf_counter()
        descriptors = self._house_descriptors() if self.images is None else self._folder_descriptors(self.images)
        path = write_atomically(self.out, self._trained(descriptors).to_text())
        info = vocabulary_info(path)
        took_s = perf_counter() - start
        with printing():
            say(results, f"vocabulary: {path}")
            say(results, f"{info.words:,} words of {len(descriptors)} images, in {took_s:.0f} s")
            say(results, f"SHA-256, as results record it: {info.vocabulary_sha256}")
        _say_use(path)

    def _check(self) -> None:
        check_shape(self.branching, self.depth)
        if self.images is not None and self.seeds is not None:
            raise ConfigError("expected one of --images and --seeds, got both; train on a folder or on houses")
        _check_least("--max-images", self.max_images, least=1)
        _check_least("--images-per-house", self.images_per_house, least=1)
        _check_least("--features", self.features, least=1)
        _check_least("--seed", self.seed, least=0)
        _check_least("--seeds", min(self.seeds or [0]), least=0)
        if any(seed < TRAINING_SEEDS.start for seed in self.seeds or ()):
            say(
                notes,
                f"slamgym: warning: results from houses that a vocabulary was trained on flatter; seeds from "
                f"{TRAINING_SEEDS.start} on are kept for training",
                style="yellow",
            )

    def _house_descriptors(self) -> list[Descriptors]:
        """One array an image."""
        seeds = TRAINING_SEEDS if self.seeds is None else self.seeds
        images = house_descriptors(seeds, self.images_per_house, self.features)
        with progress_bar("{task.completed} images") as progress:
            return list(progress.track(images, total=len(seeds) * self.images_per_house, description="houses"))

    def _folder_descriptors(self, folder: Path) -> list[Descriptors]:
        """One array an image that can be read."""
        found, unreadable = [], []
        files = image_files(folder, self.max_images)
        with progress_bar("{task.completed} images") as progress:
            for path in progress.track(files, description="images"):
                rgb = read_image(path)
                if rgb is None:
                    unreadable.append(path)
                else:
                    found.append(image_descriptors(rgb, self.features))
        if not found:
            raise ConfigError(
                f"expected images that can be read in {folder}, got {len(files)} that cannot; name another folder"
            )
        if unreadable:
            say(notes, f"slamgym: warning: left out, since unreadable: {_some_of(unreadable)}", style="yellow")
        return found

    def _trained(self, descriptors: Sequence[Descriptors]) -> Vocabulary:
        with progress_bar("{task.percentage:.0f} %") as progress:
            task = progress.add_task("words", total=1.0)
            return train(
                descriptors,
                self.branching,
                self.depth,
                self.seed,
                on_progress=lambda share: progress.update(task, completed=share),
            )


@dataclass(kw_only=True)
class Info:
    """Check a vocabulary and say what is in it.

    Example: slamgym vocab info ORBvoc.txt
    """

    file: Annotated[
        tyro.conf.Positional[Path | None],
        tyro.conf.arg(metavar="[FILE]", help="DBoW2 text file; without it, the vocabulary that comes with slamgym"),
    ] = None
    json: Annotated[bool, tyro.conf.arg(help="print a JSON object")] = False

    def __call__(self) -> None:
        with working("reading the vocabulary"):
            found = asdict(vocabulary_info(vocabulary_path(self.file)))
        with printing():
            if self.json:
                print(json.dumps(found, indent=2))
            else:
                for key, value in found.items():
                    say(results, f"{key}: {value:,}" if isinstance(value, int) else f"{key}: {value}")


@dataclass(kw_only=True)
class Fetch:
    """Download the vocabulary of ORB-SLAM2 and ORB-SLAM3 (43 MB, unpacked 145 MB) and print where it is.

    Example: slamgym run --slam-options vocabulary $(slamgym vocab fetch) --out out/run
    """

    out: Annotated[
        Path | None,
        tyro.conf.arg(metavar="FILE", help="file to write, new or empty; None: in the user's cache"),
    ] = None
    url: Annotated[str, tyro.conf.arg(help="where to get it; its checksum is verified")] = ORBVOC.url
    timeout_s: Annotated[float, tyro.conf.arg(help="seconds that the server may be silent")] = 30.0

    def __call__(self) -> None:
        if not 0 < self.timeout_s < float("inf"):
            raise ConfigError(f"expected --timeout-s above 0, got {self.timeout_s:g}; leave it out or give more")
        source = replace(ORBVOC, url=self.url)
        with working("looking for the vocabulary"):
            path = fetched_vocabulary(self.out, source)
        if path is None:
            path = self._downloaded(source)
        else:
            say(notes, "fetched already, its checksum is right")
        with printing():
            say(results, str(path))
        _say_use(path)

    def _downloaded(self, source: Source) -> Path:
        with progress_bar("{task.completed:,.0f} bytes") as progress:
            task = progress.add_task("downloading", total=None)
            return fetch_vocabulary(
                self.out,
                source,
                self.timeout_s,
                on_bytes=lambda done, total: progress.update(task, completed=done, total=total),
            )


@dataclass(kw_only=True)
class Vocab:
    """Train, inspect or fetch the vocabulary that ORB-SLAM recognises places by.

    Example: slamgym vocab fetch
    """

    command: tyro.conf.OmitSubcommandPrefixes[tyro.conf.OmitArgPrefixes[Train | Info | Fetch]]

    def __call__(self) -> None:
        self.command()


def _check_least(option: str, value: int, least: int) -> None:
    if value < least:
        raise ConfigError(f"expected {option} of at least {least}, got {value}; leave it out or give more")


def _say_use(path: Path) -> None:
    say(notes, f"to use it: --slam-options vocabulary {path}", style="dim")


def _some_of(paths: Sequence[Path]) -> str:
    named = ", ".join(map(str, paths[:_NAMED_FILES]))
    more = len(paths) - _NAMED_FILES
    return named if more <= 0 else f"{named} and {more} more"
