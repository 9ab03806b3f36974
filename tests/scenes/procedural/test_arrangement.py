"""What stands in procedural homes, and where."""

from itertools import combinations

import cv2
import numpy as np

from slamgym.scenes.home.furniture.coats import coat
from slamgym.scenes.house import House, Part, Room


def overlap(a: np.ndarray, b: np.ndarray, tolerance: float = 2e-3) -> bool:
    return bool((np.minimum(a[1], b[1]) - np.maximum(a[0], b[0]) > tolerance).all())


def test_a_furnished_home(home, size, pieces, kind_of):
    found = pieces(home)
    rich = {kind_of(name) for name, parts in found.items() if len(parts) >= 3}
    rooms = {"small": (4, 4), "medium": (4, 7), "large": (9, 11)}[size]
    assert rooms[0] <= len(home.rooms) <= rooms[1]
    assert {"living_room", "kitchen", "bedroom", "bathroom"} <= {room.kind for room in home.rooms}
    assert len(found) >= 90
    assert len(rich) >= 25
    assert {"bed", "sofa", "toilet", "washbasin", "sink", "oven", "fridge", "switch"} <= {*map(kind_of, found)}


def share_floor(a: list[Part], b: list[Part]) -> bool:
    """Whether the smallest rectangles around two pieces, seen from above, overlap: doors stand at any angle."""
    one, other = (cv2.minAreaRect(np.concatenate([p.vertices[:, :2] for p in parts])) for parts in (a, b))
    kind, corners = cv2.rotatedRectangleIntersection(one, other)
    return kind != cv2.INTERSECT_NONE and cv2.contourArea(cv2.convexHull(corners)) > 1e-4


def test_furniture_does_not_intersect(home, pieces, kind_of, bounds):
    """Chairs may be pushed under tables and desks; rugs lie under everything; tiles end behind taps."""
    found = {name: parts for name, parts in pieces(home).items() if kind_of(name) != "rug"}
    boxes = {name: bounds(parts) for name, parts in found.items()}
    meant = [{"chair", "table"}, {"office_chair", "desk"}, {"backsplash", "sink"}, {"backsplash", "oven"}]
    clashes = [
        (a, b)
        for a, b in combinations(boxes, 2)
        if overlap(boxes[a], boxes[b])
        and {kind_of(a), kind_of(b)} not in meant
        and ("door" not in {kind_of(a), kind_of(b)} or share_floor(found[a], found[b]))
    ]
    assert clashes == []


def test_furniture_is_inside_one_room(home, pieces, bounds):
    for name, parts in pieces(home).items():
        low, high = bounds(parts)
        assert low[2] > -1e-3, name
        assert any(
            low[0] >= r.x_min - 2e-3
            and low[1] >= r.y_min - 2e-3
            and high[0] <= r.x_max + 2e-3
            and high[1] <= r.y_max + 2e-3
            for r in home.rooms
        ), name


def test_only_its_own_door_stands_before_a_doorway(home, pieces, kind_of, bounds):
    """Nothing else within 0.8 m of a doorway on either side, over its clear width."""
    furniture = {n: bounds(p) for n, p in pieces(home).items() if kind_of(n) not in ("rug", "door")}
    for part in home.parts:
        if kind_of(part.name) == "doorway":
            low, high = bounds([part])
            across = int(np.argmin((high - low)[:2]))
            zone = np.array([low, [*high[:2], 2.0]])
            zone[:, 1 - across] += (0.09, -0.09)
            zone[:, across] = zone[:, across].mean() + np.array([-0.8, 0.8])
            assert [name for name, box in furniture.items() if overlap(box, zone)] == []


def in_rooms(home: House, boxes: dict[str, np.ndarray]) -> list[tuple[Room, dict[str, np.ndarray]]]:
    """Each room with the boxes whose middles lie in it."""
    middles = {name: box.mean(axis=0) for name, box in boxes.items()}
    return [
        (r, {n: boxes[n] for n, (x, y, _) in middles.items() if r.x_min < x < r.x_max and r.y_min < y < r.y_max})
        for r in home.rooms
    ]


def test_sockets_are_few_and_nothing_hangs_from_them(home, pieces, kind_of, bounds):
    sockets = {name: bounds(parts) for name, parts in pieces(home).items() if kind_of(name) == "socket"}
    assert sockets
    assert all(low[2] > 0.25 and high[2] < 0.4 for low, high in sockets.values())
    for room, found in in_rooms(home, sockets):
        assert len(found) <= (1 if room.kind in ("hall", "bathroom") else 3), room.name


def test_a_narrow_hall_is_furnished_on_one_side(house, pieces, kind_of, bounds):
    """So that a robot gets along most of it."""
    home = house("medium", 1)
    standing = {
        name: box
        for name, box in ((name, bounds(parts)) for name, parts in pieces(home).items())
        if box[0, 2] < 0.3 and kind_of(name) not in ("rug", "door", "front_door", "socket", "radiator")
    }
    ((hall, found),) = ((room, found) for room, found in in_rooms(home, standing) if room.kind == "hall")
    assert hall.y_max - hall.y_min < 1.5
    assert len(found) >= 3
    assert len({box[:, 1].mean() > (hall.y_min + hall.y_max) / 2 for box in found.values()}) == 1
    assert sum(kind_of(name) == "coat_rack" for name in pieces(home)) <= 1


def test_a_coat_has_narrow_shoulders_and_an_uneven_hem():
    x, _, z = coat(np.random.default_rng(0), 1.0).vertices.T
    assert np.ptp(x[z > -0.14]) < 0.7 * np.ptp(x[z < -0.3])
    assert np.ptp(z[z < -0.9]) > 0.03


def test_doors_stand_at_many_angles_and_none_is_shut(homes, kind_of):
    angles = []
    for home in homes:
        for part in home.parts:
            if kind_of(part.name) == "door" and part.name.endswith("/leaf"):
                (_, _), _, turn = cv2.minAreaRect(np.ascontiguousarray(part.vertices[:, :2]))
                angles.append(round(turn % 90.0))
    assert len(angles) >= 12
    assert len(set(angles)) >= 8


def test_no_picture_hangs_twice(homes, kind_of):
    for home in homes:
        shown = [p.material.name for p in home.parts if kind_of(p.name) == "picture" and p.name.endswith("/picture")]
        assert len(shown) == len(set(shown))
