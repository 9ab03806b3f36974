"""Reading catalogues of furniture, good and broken ones."""

import os
import struct
import zipfile
from pathlib import Path

import pytest

from slamgym.errors import SceneError
from slamgym.scenes.furniture_catalogue import archive as archives
from slamgym.scenes.furniture_catalogue.archive import open_archive, read_entry
from slamgym.scenes.furniture_catalogue.catalogue import Model, read_catalogue


def test_a_model_has_what_the_catalogue_says_of_it(tmp_path, write_catalogue, entry, files):
    text = entry(
        name="Canap\\u00e9 \\\n    bleu",
        creator="Ren\xe9",
        elevation="45",
        dropOnTopElevation="41.5",
        modelRotation="0 0 1 0 1 0 -1 0 0",
    )
    path = write_catalogue("a.sh3f", text, licence="Creative Commons Attribution 3.0 license \xa9 Ren\xe9")
    (model,) = read_catalogue(tmp_path).models
    assert model == Model(
        id="Test#model1",
        name="Canapé bleu",
        category="Living room",
        size_m=(2.0, 0.9, 0.8),
        elevation_m=0.45,
        drop_on_top_m=0.415,
        licence="CC-BY 3.0",
        creator="René",
        archive=path,
        changed_ns=path.stat().st_mtime_ns,
        path="sofa/thing.obj",
        mesh_bytes=len(files()["sofa/thing.obj"]),
        rotation=(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0),
    )


def test_what_a_catalogue_leaves_unsaid_has_defaults(tmp_path, write_catalogue, entry):
    write_catalogue("a.sh3f", entry(1), entry(2, dropOnTopElevation="-1"))
    plain, bare = read_catalogue(tmp_path).models
    assert (plain.elevation_m, plain.drop_on_top_m, plain.rotation) == (0.0, 0.8, None)
    assert bare.drop_on_top_m is None


@pytest.mark.parametrize(
    ("licence", "word"),
    [
        ("Public domain", "CC0"),
        ("CC0", "CC0"),
        ("Creative Commons Attribution 3.0 Unported license  (c) Scopia", "CC-BY 3.0"),
        ("Creative Commons Attribution-ShareAlike 4.0", "other: Creative Commons Attribution-ShareAlike 4.0"),
        ("Creative Commons Attribution NonCommercial 4.0", "other: Creative Commons Attribution NonCommercial 4.0"),
        ("Creative Commons Attribution license", "CC-BY"),
        ("Attribution 4.0, no derivatives", "other: Attribution 4.0, no derivatives"),
        ("Free Art License", "other: Free Art License"),
        ("", "other"),
    ],
)
def test_the_licence_is_told_in_short(tmp_path, licence, word, write_catalogue):
    write_catalogue("a.sh3f", licence=licence)
    assert read_catalogue(tmp_path).models[0].licence == word


def test_a_models_own_licence_counts_before_the_catalogues(tmp_path, write_catalogue, entry):
    write_catalogue("a.sh3f", entry(1), entry(2, license="Free Art License"))
    assert [model.licence for model in read_catalogue(tmp_path).models] == ["CC0", "other: Free Art License"]


def test_what_a_catalogue_tells_stays_in_one_line(tmp_path, write_catalogue, entry):
    write_catalogue("a.sh3f", entry(name="So\\nfa", creator="Ada\\r\\n  B"), licence="Odd\\nterms")
    (model,) = read_catalogue(tmp_path).models
    assert (model.name, model.creator, model.licence) == ("So fa", "Ada B", "other: Odd terms")


@pytest.mark.parametrize("folder", ["", "missing"])
def test_without_a_catalogue_the_message_says_how_to_get_one(tmp_path, folder):
    with pytest.raises(SceneError, match=r"got none; install them with `apt install sweethome3d-furniture`"):
        read_catalogue(tmp_path / folder)


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"width": "nan"}, "got 'nan'"),
        ({"depth": "-5"}, "got '-5'"),
        ({"height": "1e9"}, "got '1e9'"),
        ({"width": "wide"}, "'wide'"),
        ({"name": None}, "expected 'name', which is not there"),
        ({"model": "/sofa/none.obj"}, "expected 'sofa/none.obj', which is not there"),
        ({"model": "../../etc/passwd.obj"}, "got '../../etc/passwd.obj'"),
        ({"model": "/sofa/cloth.png"}, "expected a .obj file"),
        ({"modelRotation": "1 0 0"}, "expected 9 numbers of a rotation"),
        ({"modelRotation": "9 0 0 0 9 0 0 0 9"}, "expected 9 numbers of a rotation"),
    ],
)
def test_a_bad_entry_is_left_out_and_the_others_stay(tmp_path, changed, why, write_catalogue, entry):
    write_catalogue("a.sh3f", entry(1, **changed), entry(2))
    catalogue = read_catalogue(tmp_path)
    assert [model.id for model in catalogue.models] == ["Test#model2"]
    (defect,) = catalogue.defects
    assert defect.startswith("a.sh3f: model '1' left out: ")
    assert why in defect
    assert "\n" not in defect


def test_a_bad_archive_is_left_out_and_the_others_stay(tmp_path, write_catalogue):
    good = write_catalogue("a.sh3f")
    (tmp_path / "b.sh3f").write_bytes(good.read_bytes()[:-30])
    (tmp_path / "c.sh3f").write_bytes(b"")
    os.mkfifo(tmp_path / "d.sh3f")
    with zipfile.ZipFile(tmp_path / "e.sh3f", "w") as archive:
        archive.writestr("other.txt", b"no catalogue")
    with zipfile.ZipFile(tmp_path / "f.sh3f", "w") as archive:
        archive.writestr("PluginFurnitureCatalog.properties", b"name#1=\\uZZZZ")
    catalogue = read_catalogue(tmp_path)
    assert [model.archive for model in catalogue.models] == [good]
    assert [defect[:20] for defect in catalogue.defects] == [f"catalogue {name}.sh3f lef" for name in "bcdef"]
    assert all("expected" in defect or "Invalid" in defect for defect in catalogue.defects)
    assert not any("\n" in defect for defect in catalogue.defects)


def test_a_changed_catalogue_is_read_again(tmp_path, write_catalogue, entry):
    path = write_catalogue("a.sh3f")
    assert len(read_catalogue(tmp_path).models) == 1
    write_catalogue(path.name, entry(1), entry(2))
    os.utime(path, ns=(1, 1))
    assert len(read_catalogue(tmp_path).models) == 2


def test_an_entry_is_refused_before_it_is_unpacked(tmp_path, write_catalogue):
    path = write_catalogue("a.sh3f", content={"zeros": bytes(50_000_000)})
    with open_archive(path) as archive:
        with pytest.raises(SceneError, match="expected at most 32000000 bytes, deflated, got 50000000 by method 8"):
            read_entry(archive, "zeros")
        with pytest.raises(SceneError, match=r"'\.\./\.\./etc/passwd': expected an entry of the archive"):
            read_entry(archive, "../../etc/passwd")


def test_an_entry_that_is_larger_than_it_says_is_refused(tmp_path, write_catalogue):
    path = write_catalogue("a.sh3f", content={"zeros": bytes(1_000_000)})
    data = path.read_bytes()
    path.write_bytes(data.replace(struct.pack("<L", 1_000_000), struct.pack("<L", 1000)))
    with open_archive(path) as archive, pytest.raises(SceneError, match="expected a readable entry, got BadZipFile"):
        read_entry(archive, "zeros")


def test_a_packed_way_that_has_no_bound_is_refused(tmp_path):
    path = tmp_path / "a.sh3f"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("zeros", bytes(1000))
    with open_archive(path) as archive, pytest.raises(SceneError, match="got 1000 by method 14; pack it again"):
        read_entry(archive, "zeros")


def test_the_list_of_entries_is_bounded_before_it_is_read(tmp_path, monkeypatch, write_catalogue, files):
    path = write_catalogue("a.sh3f", content={**files(), **{f"{i:04}": b"" for i in range(1000)}})
    monkeypatch.setattr(archives, "MAX_DIRECTORY_BYTES", 40_000)
    with pytest.raises(SceneError, match=r"expected a zip file with at most 40000 bytes of directory, got [4-9]"):
        open_archive(path)


def test_the_installed_catalogues_are_read_whole():
    folder = Path("/usr/share/sweethome3d/furniture")
    if not folder.is_dir():
        pytest.skip("expected Debian's sweethome3d-furniture; install it with apt")
    catalogue = read_catalogue(folder)
    assert catalogue.defects == ()
    assert len(catalogue.models) >= 800
    assert {model.licence for model in catalogue.models} == {"CC0", "CC-BY 3.0"}
