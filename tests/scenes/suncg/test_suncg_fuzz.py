"""Broken and hostile datasets: each gives a house or an error of one line, and nothing outside the root is read."""

import shutil

import pytest

ENTRY = "house/h1/house.json"


@pytest.fixture
def corpus(dataset, hostile_folder):
    shutil.copytree(dataset().parents[2], hostile_folder, dirs_exist_ok=True)
    for name in ("link.png", "pipe.png"):
        (hostile_folder / name).rename(hostile_folder / "texture" / name)
    return hostile_folder


def run(fuzz, corpus, count, seed, limit_s):
    told = fuzz(
        "slamgym.scenes.suncg:Suncg", "slamgym.scenes.suncg.reader:read_suncg", corpus, [ENTRY], count, seed, limit_s
    )
    assert sum(told.values()) == count
    return told


def test_200_broken_datasets(fuzz, corpus):
    told = run(fuzz, corpus, 200, seed=1, limit_s=120)
    # As it should be with such damage: some of it harmless, some beyond repair.
    assert all(told["house.json", outcome] for outcome in ("read", "refused")), told


@pytest.mark.fuzz
def test_10_000_broken_datasets(fuzz, corpus):
    run(fuzz, corpus, 10_000, seed=2, limit_s=3000)
