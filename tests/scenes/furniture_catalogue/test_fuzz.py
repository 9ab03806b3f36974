"""Broken and hostile catalogues: each gives models or an error of one line, and nothing outside its folder is read."""

import pytest

LIST = "PluginFurnitureCatalog.properties"
ENTRIES = (LIST, "all.sh3f")


@pytest.fixture
def corpus(hostile_folder, write_catalogue, entry, files):
    """The files of a catalogue of two models, and the same packed."""
    content = {name.removeprefix("sofa/"): data for name, data in files().items()}
    entries = [
        entry(1, model="/thing.obj", elevation="45", dropOnTopElevation="79", modelRotation="0 0 1 0 1 0 -1 0 0"),
        entry(2, model="/thing.obj", name="Canap\\u00e9 \\\n    bleu"),
    ]
    packed = write_catalogue("all.sh3f", *entries, content=content)
    packed.rename(hostile_folder / packed.name)
    (hostile_folder / LIST).write_text("license=Public domain\n" + "".join(entries), "latin-1")
    for name, data in content.items():
        (hostile_folder / name).write_bytes(data)
    return hostile_folder


def run(fuzz, corpus, count, seed, limit_s):
    loader, reader = "slamgym.scenes.sweethome:SweetHome", "furniture_catalogue.packed:read_models"
    told = fuzz(loader, reader, corpus, ENTRIES, count, seed, limit_s)
    assert sum(told.values()) == count
    return told


def test_200_broken_catalogues(fuzz, corpus):
    told = run(fuzz, corpus, 200, seed=1, limit_s=120)
    assert all(told[name, outcome] for name in ENTRIES for outcome in ("read", "refused")), told


@pytest.mark.fuzz
def test_10_000_broken_catalogues(fuzz, corpus):
    run(fuzz, corpus, 10_000, seed=2, limit_s=3000)
