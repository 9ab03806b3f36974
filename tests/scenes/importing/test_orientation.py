from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import trimesh

from slamgym.errors import ConfigError, SceneError
from slamgym.scenes.house import Material
from slamgym.scenes.importing.levels import lowest_storey
from slamgym.scenes.importing.orientation import FORMATS, placed, placement
from slamgym.scenes.importing.pieces import Piece
from slamgym.scenes.importing.placed_options import PlacedOptions

AUTO = PlacedOptions()
# Rows: the world's axes, z up, in the file's frame: y up is a quarter turn about x, x up one about y.
TURNED = {
    "x": [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
    "y": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    "z": np.eye(3),
}


def box(name, low, high):
    mesh = trimesh.creation.box(bounds=[low, high])
    return Piece(name, Material(name), np.array(mesh.vertices, float), np.array(mesh.faces))


def slab(name, low, high):
    """Upper side of a box only, seen from above."""
    (x0, y0, z), (x1, y1, _) = low, high
    corners = np.array([[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]], float)
    return Piece(name, Material(name), corners, np.array([[0, 1, 2], [0, 2, 3]]))


def flat():
    """8 x 5 m, 2.5 m high, floor at z = 0; z up."""
    return [
        box("shell", (0, 0, 0), (8, 5, 2.5)),
        box("table", (1, 1, 0), (2.5, 2, 0.75)),
        box("shelf", (7, 1, 0), (8, 2, 2)),
    ]


def in_file(pieces, up, unit):
    turn = np.array(TURNED[up], float)
    return [replace(piece, vertices=piece.vertices @ turn / unit) for piece in pieces]


@pytest.mark.parametrize("up", "xyz")
@pytest.mark.parametrize("unit", [1.0, 0.01, 0.001, 0.0254, 0.3048])
def test_axis_and_unit_are_seen(up, unit):
    found = placement(in_file(flat(), up, unit), AUTO, FORMATS["obj"])
    parts, turned = placed(in_file(flat(), up, unit), found.T_world_file)
    assert np.linalg.det(found.T_world_file[:3, :3]) == pytest.approx(unit**3)
    for part, piece in zip(parts, flat(), strict=True):
        np.testing.assert_allclose(part.vertices, piece.vertices, atol=1e-5)
    assert turned == ["turned inside out, as its floor looked down: 'shell'"]  # a box is seen from outside


def test_what_was_taken_for_granted_is_told():
    assert placement(in_file(flat(), "y", 0.01), AUTO, FORMATS["ply"]).assumptions == [
        "up axis: y, seen in the geometry (.ply says z, but a storey would be 500 high with z up, not 250)",
        "unit: 0.01 m, the centimetre, as a storey is 250 high",
        "floor: at 0 m, a level surface of 100% of the rectangle",
    ]
    given = PlacedOptions(up="y", unit=0.01, floor=0.4)
    assert placement(in_file(flat(), "y", 0.01), given, FORMATS["ply"]).assumptions == [
        "up axis: y, as given",
        "unit: 0.01 m, as given",
        "floor: at 0.4 m, as given",
    ]


def test_a_cube_is_as_its_format_has_it():
    cube = [box("room", (0, 0, 0), (3, 3, 3))]
    for kind, up in (("glb", "y"), ("obj", "y"), ("ply", "z"), ("stl", "z")):
        told = placement(cube, AUTO, FORMATS[kind]).assumptions[0]
        assert told.startswith(f"up axis: {up}, as ")


def test_glb_is_in_metres_also_in_a_tall_hall():
    hall = [box("hall", (0, 0, 0), (30, 20, 9))]
    assert placement(hall, AUTO, FORMATS["glb"]).assumptions[1] == "unit: 1 m, as a storey is 9.00 high"
    assert placement(hall, AUTO, FORMATS["stl"]).assumptions[1] == "unit: 0.3048 m, the foot, as a storey is 9 high"


@pytest.mark.parametrize(
    ("height", "unit"),
    [(6.8, "1 m"), (7.0, "1 m"), (8.5, "0.3048 m"), (11.8, "1 m"), (14.0, "0.3048 m"), (98, "0.0254 m")],
)
def test_feet_and_inches_are_of_usual_storeys(height, unit):
    hall = [box("hall", (0, 0, 0), (4.0 * height, 3.0 * height, height))]
    assert placement(hall, AUTO, FORMATS["ply"]).assumptions[1].startswith(f"unit: {unit}, ")


def test_what_is_given_is_used():
    found = placement(flat(), PlacedOptions(up="x", unit=2.0, floor=0.5), FORMATS["glb"])
    corner = found.T_world_file @ [1.0, 2.0, 3.0, 1.0]
    np.testing.assert_allclose(corner, [-6.0, 4.0, 1.5, 1.0])


def test_the_floor_is_the_upper_side_of_the_lowest_slab():
    two_storeys = [
        box("slab", (0, 0, -0.3), (8, 5, 0.15)),
        box("walls", (0, 0, 0.15), (8, 5, 2.85)),
        box("ceiling", (0, 0, 2.75), (8, 5, 2.95)),
        box("walls above", (0, 0, 2.95), (8, 5, 5.5)),
        box("table", (1, 1, 0.15), (3, 2, 0.9)),
    ]
    storey = lowest_storey(np.concatenate([p.vertices[p.faces] for p in two_storeys]), axis=2)
    assert storey.floor.height == pytest.approx(0.15)
    assert storey.coverage == 1.0
    assert storey.height == pytest.approx(2.6, abs=0.11)
    T = placement(two_storeys, AUTO, FORMATS["stl"]).T_world_file
    assert T[2, 3] == pytest.approx(-0.15)


def test_a_floor_alone_is_a_scene_and_a_ball_is_none():
    assert (
        "floor: at 0.2 m" in placement([slab("floor", (0, 0, 0.2), (5, 5, 0.2))], AUTO, FORMATS["ply"]).assumptions[2]
    )
    ball = trimesh.creation.icosphere(subdivisions=3)
    piece = Piece("ball", Material("ball"), np.array(ball.vertices), np.array(ball.faces))
    with pytest.raises(SceneError, match=r"no floor found: .* got 4% .* give the scene options up, unit and floor"):
        placement([piece], AUTO, FORMATS["ply"])
    assert placement([piece], PlacedOptions(floor=-1.0), FORMATS["ply"]).T_world_file[2, 3] == 1.0


def storeys(count, length, width, height=2.6, pitch=3.0):
    return [box(f"storey{k}", (0, 0, pitch * k), (length, width, pitch * k + height)) for k in range(count)]


NARROW = {
    "corridor": storeys(1, 20, 1.5, 2.7),
    "bathroom": [*storeys(1, 2.2, 1.7, 2.5), box("tub", (0, 0, 0), (1.6, 0.7, 0.5))],
    "room": storeys(1, 3.5, 2.0),
    "corridors": storeys(2, 12, 2.2),
    "terraced house": storeys(3, 5, 9),
    "tower": storeys(4, 12, 10),
    "high tower": storeys(10, 12, 10),
    "slim tower": storeys(8, 4, 4),
    "block": storeys(8, 30, 20),
    "tower on a lawn": [*storeys(6, 12, 10), slab("lawn", (-20, -20, -0.3), (40, 40, -0.3))],
}


@pytest.mark.parametrize("kind", ["glb", "obj", "ply"])
@pytest.mark.parametrize("pieces", NARROW.values(), ids=NARROW)
def test_narrow_and_tall_scenes_stand(pieces, kind):
    form = FORMATS[kind]
    found = placement(in_file(pieces, form.up, 1.0), AUTO, form)
    assert found.assumptions[:2] == [f"up axis: {form.up}, as {form.name} has it", found.assumptions[1]]
    assert found.assumptions[1].startswith("unit: 1 m, as a storey is 2.")
    assert found.T_world_file[2, 3] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("unit", "name"), [(0.3048, "foot"), (0.0254, "inch")])
def test_a_narrow_room_stands_in_feet_and_inches(unit, name):
    told = placement(in_file(NARROW["bathroom"], "y", unit), AUTO, FORMATS["obj"]).assumptions
    assert told[0] == "up axis: y, as .obj has it"
    assert told[1].startswith(f"unit: {unit:g} m, the {name}")


def test_a_galley_kitchen_without_ceiling_stands():
    counter = box("counter", (0, 0, 0), (3, 0.6, 0.9))
    kitchen = [without(box("kitchen", (0, 0, 0), (3, 1.8, 2.6)), 2, 1), counter]
    told = placement(in_file(kitchen, "y", 1.0), AUTO, FORMATS["glb"]).assumptions
    assert told[:2] == ["up axis: y, as glTF has it", "unit: 1 m, as a storey is 2.60 high"]


@pytest.mark.parametrize("depths", [(4.2, 3.9), (3.2, 1.4, 3.4)])
def test_rooms_in_rows_are_no_storeys(depths):
    edges = np.cumsum([0, *depths])
    rows = [box(f"row{k}", (0, y0, 0), (10, y1, 2.5)) for k, (y0, y1) in enumerate(pairwise(edges))]
    for up, kind in (("z", "glb"), ("z", "obj"), ("y", "stl")):
        told = placement(in_file(rows, up, 1.0), AUTO, FORMATS[kind]).assumptions[0]
        assert told.startswith(f"up axis: {up}, seen in the geometry")


def test_a_wall_through_the_middle_is_no_storey():
    house = [box("house", (0, 0, 0), (10, 6.6, 2.5)), box("wall", (0, 3.2, 0), (6.5, 3.4, 2.5))]
    assert placement(house, AUTO, FORMATS["glb"]).assumptions[0].startswith("up axis: z, seen in the geometry")


def test_a_slim_house_of_uneven_storeys_stands():
    house = [box("below", (0, 0, 0), (8, 2.4, 2.9)), box("above", (0, 0, 3.1), (8, 2.4, 5.2))]
    assert placement(in_file(house, "y", 1.0), AUTO, FORMATS["glb"]).assumptions[0] == "up axis: y, as glTF has it"


@pytest.mark.parametrize("kind", ["glb", "obj", "stl"])
@pytest.mark.parametrize(
    "pieces",
    [
        storeys(1, 6, 4, 1.9),
        [slab("floor", (0, 0, 0), (5, 4, 0)), box("shelf", (0, 0, 0), (0.4, 4, 1.8))],
        [slab("floor", (0, 0, 0), (5, 4, 0)), box("bed", (1, 1, 0), (3, 2, 0.5)), box("board", (4, 0, 0), (5, 1, 1.2))],
    ],
)
def test_what_is_lower_than_a_room_stands(pieces, kind):
    form = FORMATS[kind]
    told = placement(in_file(pieces, form.up, 1.0), AUTO, form).assumptions
    assert told[0] == f"up axis: {form.up}, as {form.name} has it"


def test_a_large_table_is_no_ceiling():
    room = [without(box("room", (0, 0, 0), (6, 5, 2.6)), 2, 1), box("table", (1, 1, 0.7), (5, 4, 0.73))]
    assert placement(room, AUTO, FORMATS["stl"]).assumptions[1] == "unit: 1 m, as a storey is 2.60 high"


def test_low_beds_apart_are_no_floor():
    beds = [
        bed
        for x, y in ((0, 0), (0, 3), (3, 0), (3, 3))
        for bed in (box("bed", (x, y, 0), (x + 2, y + 1, 0.2)), box("board", (x, y, 0), (x + 0.1, y + 1, 1.2)))
    ]
    told = placement([slab("floor", (0, 0, 0), (10, 10, 0)), *beds], AUTO, FORMATS["stl"]).assumptions[2]
    assert told == "floor: at 0 m, a level surface of 100% of the rectangle"


def test_a_tower_has_its_floor_below_also_when_up_is_given():
    corners = np.concatenate([p.vertices[p.faces] for p in storeys(12, 12, 10)])
    storey = lowest_storey(corners, axis=2)
    assert (storey.floor.height, storey.height) == pytest.approx((0.0, 2.6))
    assert placement(storeys(12, 12, 10), PlacedOptions(up="z"), FORMATS["glb"]).T_world_file[2, 3] == 0.0


LAWN = slab("lawn", (-15, -15, 0), (25, 25, 0))
RAISED = box("house", (0, 0, 0.3), (10, 8, 2.9))


def test_a_house_above_its_lawn_is_the_floor_and_both_are_told():
    found = placement([LAWN, RAISED], AUTO, FORMATS["stl"])
    assert found.T_world_file[2, 3] == pytest.approx(-0.3)
    assert found.assumptions[2] == (
        "floor: at 0.3 m, a level surface of 5% of the rectangle; another is at 0 m: scene option floor chooses"
    )


def test_a_fence_leaves_it_open_and_tells_both():
    fence = without(box("fence", (-15, -15, 0), (25, 25, 0.4)), 2, 0)
    told = placement([LAWN, RAISED, fence], AUTO, FORMATS["stl"]).assumptions[2]
    assert told.startswith("floor: at 0 m, ")
    assert told.endswith("; another is at 0.3 m: scene option floor chooses")


def test_a_platform_in_a_room_is_not_its_floor():
    room = [box("room", (0, 0, 0), (8, 5, 2.6)), box("stage", (0, 0, 0), (3, 3, 0.3))]
    assert placement(room, AUTO, FORMATS["stl"]).assumptions[2] == (
        "floor: at 0 m, a level surface of 100% of the rectangle"
    )


def without(piece, axis, sign):
    """The piece without its faces that look along an axis; sign 0: in either direction."""
    a, b, c = np.moveaxis(piece.vertices[piece.faces], 1, 0)
    along = np.cross(b - a, c - a)[:, axis]
    return replace(piece, faces=piece.faces[(along * sign <= 0) if sign else (along == 0)])


def turned_over(piece):
    return replace(piece, faces=piece.faces[:, ::-1])


ROOM = box("room", (0, 0, 0), (6, 5, 2.6))
PARAPET = without(box("parapet", (0, 0, 2.6), (6, 5, 3.4)), 2, 0)
THICK_WALLS = [
    *(box("wall", (0, y, 0), (6, y + 0.2, 2.6)) for y in (0, 4.8)),
    *(box("wall", (x, 0.2, 0), (x + 0.2, 4.8, 2.6)) for x in (0, 5.8)),
]


@pytest.mark.parametrize("kind", ["glb", "ply"])
@pytest.mark.parametrize("up", "xyz")
@pytest.mark.parametrize("unit", [1.0, 0.01])
@pytest.mark.parametrize(
    ("pieces", "instead"),
    [
        ([without(ROOM, 2, -1)], "got one with 0 m above it and 2.6 m below it"),
        ([turned_over(without(ROOM, 2, -1)), PARAPET], "got one with 0.8 m above it"),
        ([without(ROOM, 2, 0)], "got what may be walls with"),
        ([without(ROOM, 2, 0), box("table", (1, 1, 0), (2.5, 2, 0.75))], "got what may be walls with"),
        (THICK_WALLS, "got what may be walls with"),
    ],
)
def test_a_ceiling_or_a_wall_is_no_floor(pieces, instead, unit, up, kind):
    with pytest.raises(SceneError, match=r"^no floor found: expected a level surface") as told:
        placement(in_file(pieces, up, unit), AUTO, FORMATS[kind])
    if unit == 1.0:
        assert instead in str(told.value)
    given = PlacedOptions(up=up, unit=unit, floor=0.0)
    assert placement(in_file(pieces, up, unit), given, FORMATS[kind]).T_world_file[2, 3] == 0.0


def test_a_room_without_ceiling_or_one_wall_has_a_floor():
    for axis, sign in ((2, 1), (0, 1), (1, -1)):
        for up in "xyz":
            found = placement(in_file([without(ROOM, axis, sign)], up, 1.0), AUTO, FORMATS["stl"])
            np.testing.assert_allclose(found.T_world_file[:3, :3], np.array(TURNED[up], float), atol=1e-12)
            assert found.T_world_file[2, 3] == pytest.approx(0.0)


def test_a_floor_that_looks_down_is_turned_and_furniture_is_not():
    floor = slab("floor", (0, 0, 0), (8, 5, 0))
    inverted = replace(floor, faces=floor.faces[:, ::-1])
    table = box("table", (1, 1, 0), (2, 2, 0.7))  # its underside, at the floor, looks down
    parts, told = placed([inverted, table], np.eye(4))
    assert told == ["turned inside out, as its floor looked down: 'floor'"]
    assert (np.sort(parts[0].faces) == np.sort(floor.faces)).all()
    corners = parts[0].vertices[parts[0].faces]
    assert (np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0).all()
    assert (parts[1].faces == table.faces).all()
    assert placed([floor, table], np.eye(4))[1] == []


def test_floors_of_rooms_are_turned_one_by_one_under_their_furniture():
    floors = [slab(f"floor{k}", (3 * k, 0, 0), (3 * k + 3, 3, 0)) for k in range(12)]
    beds = [box(f"bed{k}", (3 * k + 1, 0, 0), (3 * k + 3, 2, 0.5)) for k in range(12)]
    for wrong in (range(12), [4]):
        given = [turned_over(floor) if k in wrong else floor for k, floor in enumerate(floors)]
        parts, told = placed([*beds, *given], np.eye(4))
        assert told == [f"turned inside out, as its floor looked down: 'floor{k}'" for k in wrong]
        assert all((np.sort(part.faces) == np.sort(bed.faces)).all() for part, bed in zip(parts, beds, strict=False))
        for part in parts[12:]:
            a, b, c = part.vertices[part.faces[0]]
            assert np.cross(b - a, c - a)[2] > 0


def test_what_is_smaller_than_a_floor_is_not_turned():
    stool = box("stool", (1, 1, 0), (1.6, 1.6, 0.5))
    assert placed([stool], np.eye(4))[1] == []


def test_halves_of_a_house_seen_from_outside_are_turned():
    halves = [box("west", (0, 0, 0), (4, 5, 2.5)), box("east", (4, 0, 0), (8, 5, 2.5))]
    assert [line.rpartition(" ")[2] for line in placed(halves, np.eye(4))[1]] == ["'west'", "'east'"]


def test_map_coordinates_keep_their_millimetres():
    offset = np.array([500_000.0, 5_500_000.0, 320.0])
    surveyed = [replace(piece, vertices=piece.vertices + offset) for piece in flat()]
    found = placement(surveyed, AUTO, FORMATS["obj"])
    part = placed(surveyed, found.T_world_file)[0][1]
    np.testing.assert_allclose(np.ptp(part.vertices, axis=0), [1.5, 1.0, 0.75], atol=1e-5)
    assert "moved by (-500004.00, -5500002.50) m, to the origin" in found.assumptions


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"up": "w"}, "up"),
        ({"unit": 0.0}, "'unit': expected .* metres as 0.01 from 1e-06 to 10000, got '0.0'$"),
        ({"unit": "1e5"}, "'unit': .* from 1e-06 to 10000"),
        ({"unit": "yard"}, "^scene option 'unit': expected auto, m, cm, mm, inch, foot or metres as 0.01, got 'yard'$"),
        ({"unit": None}, "'unit': expected auto"),
        ({"floor": "low"}, "^scene option 'floor': expected auto or metres as -0.3, got 'low'$"),
        ({"floor": "-2e4"}, "'floor': .* from -10000 to 10000"),
        ({"ups": "z"}, "up"),
    ],
)
def test_bad_options_are_told(options, message):
    with pytest.raises(ConfigError, match=message):
        PlacedOptions.checked(options)


def test_options_may_come_as_text():
    assert PlacedOptions.checked({"unit": "0.01", "floor": "-0.3"}) == PlacedOptions(unit=0.01, floor=-0.3)
    assert PlacedOptions.checked({"unit": "auto", "floor": "auto"}) == PlacedOptions()


@pytest.mark.parametrize(("word", "metres"), [("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("inch", 0.0254)])
def test_units_have_words(word, metres):
    assert PlacedOptions.checked({"unit": word}).unit == metres
