"""Which models of a catalogue can stand where a piece made by code would."""

from dataclasses import dataclass

from slamgym.scenes.furniture_catalogue.catalogue import Model

Size = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Wanted:
    """Models by their names, in lower case, and sizes.

    smallest, largest: width, depth, height in metres, for what a room's layout has space for. max_kb: of the mesh;
    pieces that stand in numbers are light. category: "" for any. at_elevation: the catalogue's height above the floor
    counts; else the layout's. same_size: stretched to the piece made by code, as others are placed by its size.
    in_row: beside others like it, which look alike then.
    """

    names: tuple[str, ...]
    smallest: Size
    largest: Size
    max_kb: int = 500
    category: str = ""
    at_elevation: bool = False
    same_size: bool = False
    in_row: bool = False

    def suits(self, model: Model) -> bool:
        """Whether the model is one of these."""
        sizes = zip(self.smallest, model.size_m, self.largest, strict=True)
        return (
            model.name.lower() in self.names
            and self.category in ("", model.category)
            and all(low <= size <= high for low, size, high in sizes)
            and model.mesh_bytes <= 1000 * self.max_kb
            and model.id not in LEFT_OUT
        )


_SEATS_AND_BEDS = {
    "sofa": Wanted(
        ("sofa", "couch", "clear sofa", "burlap sofa", "winchester sofa", "sofa 2 seats", "sofa 3 seats"),
        (1.5, 0.65, 0.6),
        (2.4, 1.0, 1.1),
        max_kb=1500,
    ),
    "armchair": Wanted(
        ("armchair", "modern armchair", "winchester armchair"),
        (0.5, 0.5, 0.6),
        (1.15, 0.95, 1.05),
        max_kb=800,
        category="Living room",
    ),
    "chair": Wanted(
        ("chair", "chair with cushion", "oak chair", "osaka chair", "plastic chair"),
        (0.38, 0.4, 0.75),
        (0.56, 0.63, 1.2),
        max_kb=250,
        category="Living room",
    ),
    "office_chair": Wanted(("chair",), (0.5, 0.5, 0.85), (0.7, 0.7, 1.1), max_kb=700, category="Office"),
    "ottoman": Wanted(("stool", "puff"), (0.3, 0.3, 0.3), (0.95, 0.95, 0.62)),
    "double_bed": Wanted(("bed", "iron bed"), (1.3, 2.0, 0.6), (2.05, 2.35, 1.2), max_kb=1500),
    "single_bed": Wanted(("bed", "child bed", "captain's bed"), (0.85, 1.9, 0.6), (1.1, 2.2, 1.0), max_kb=900),
}

_TABLES_AND_CABINETS = {
    "dining_table": Wanted(
        ("table", "oak table", "round table", "wooden table", "table on trestles"), (1.1, 0.65, 0.7), (1.75, 1.25, 0.8)
    ),
    "kitchen_table": Wanted(("table", "round table", "table with tablecloth"), (0.6, 0.5, 0.62), (1.15, 1.12, 0.8)),
    "coffee_table": Wanted(("coffee table", "table"), (0.8, 0.4, 0.38), (1.45, 0.78, 0.56)),
    "round_table": Wanted(("round table", "table"), (0.4, 0.4, 0.5), (0.7, 0.7, 0.78)),
    "desk": Wanted(("desk", "desk table", "wooden desk"), (1.0, 0.5, 0.7), (1.65, 0.85, 0.78), same_size=True),
    "wardrobe": Wanted(("wardrobe",), (0.85, 0.45, 1.9), (2.2, 0.72, 2.4)),
    "dresser": Wanted(("chest", "dresser with drawers", "changing table"), (0.8, 0.35, 0.7), (1.65, 0.6, 1.0)),
    "nightstand": Wanted(("bedside table",), (0.35, 0.3, 0.4), (0.55, 0.55, 0.6), same_size=True),
    "sideboard": Wanted(("sideboard", "dresser with drawers"), (1.0, 0.35, 0.6), (1.8, 0.6, 1.0)),
    "bookshelf": Wanted(
        ("bookcase", "full bookcase", "shelves", "vertical shelves"), (0.4, 0.25, 1.1), (1.75, 0.45, 2.3)
    ),
    "tv_bench": Wanted(("tv stand",), (1.0, 0.35, 0.3), (1.8, 0.6, 0.6)),
    "television": Wanted(("tv", "tv 16:9"), (0.5, 0.05, 0.4), (1.2, 0.35, 0.8), max_kb=700),
}

_KITCHEN_AND_BATHROOM = {
    "cupboard": Wanted(("lower cabinet", "drawers cabinet"), (0.58, 0.55, 0.85), (0.62, 0.65, 0.92), in_row=True),
    "sink": Wanted(("sink cabinet",), (0.58, 0.55, 0.85), (0.62, 0.65, 1.3), in_row=True),
    "wall_cupboard": Wanted(("upper cabinet", "glass door cabinet"), (0.55, 0.3, 0.5), (0.62, 0.42, 0.8), in_row=True),
    "hood": Wanted(("range hood", "hood"), (0.55, 0.25, 0.1), (0.62, 0.55, 0.6)),
    "fridge": Wanted(("fridge", "refrigerator"), (0.5, 0.5, 1.1), (0.62, 0.68, 2.1), same_size=True),
    "toilet": Wanted(("toilets unit",), (0.33, 0.5, 0.6), (0.5, 0.9, 0.95)),
    "washbasin": Wanted(
        ("washbasin", "small lavatory", "vanity"), (0.45, 0.38, 0.3), (0.95, 0.72, 1.0), at_elevation=True
    ),
    "washing_machine": Wanted(
        ("clothes washing machine", "dryer machine", "washing machine"), (0.55, 0.5, 0.7), (0.65, 0.65, 0.95)
    ),
    "laundry_basket": Wanted(("clothes basket",), (0.3, 0.3, 0.4), (0.62, 0.55, 0.75)),
    "towel_rail": Wanted(("radiator",), (0.4, 0.05, 0.9), (0.7, 0.25, 1.7), category="Bathroom", at_elevation=True),
}

_LAMPS_AND_PLANTS = {
    "floor_lamp": Wanted(("lamp",), (0.25, 0.25, 1.2), (0.6, 0.6, 1.9)),
    "table_lamp": Wanted(("lamp", "little lamp"), (0.12, 0.12, 0.35), (0.42, 0.42, 0.75)),
    "desk_lamp": Wanted(("desk lamp",), (0.1, 0.1, 0.35), (0.42, 0.42, 0.6)),
    "plant": Wanted(
        ("plant", "decorative plant", "indoor plant", "ficus", "yucca", "bamboo"),
        (0.25, 0.25, 0.5),
        (1.1, 1.05, 1.9),
        max_kb=720,
    ),
    "small_plant": Wanted(("little plant", "cactus", "succulent plant"), (0.1, 0.1, 0.1), (0.3, 0.3, 0.3), max_kb=200),
}

_SMALL_THINGS = {
    "vase": Wanted(("vase", "old jar"), (0.1, 0.1, 0.1), (0.35, 0.35, 0.52), max_kb=200),
    "mug": Wanted(("coffee mug", "coffee cup"), (0.05, 0.05, 0.04), (0.15, 0.15, 0.16), max_kb=160),
    "fruit_bowl": Wanted(("bowl with fruits", "bowl with salad"), (0.2, 0.2, 0.08), (0.4, 0.4, 0.22)),
    "toaster": Wanted(("toaster",), (0.2, 0.1, 0.1), (0.4, 0.3, 0.3)),
    "kettle": Wanted(("boiler", "teapot"), (0.1, 0.1, 0.1), (0.3, 0.3, 0.35)),
    "knife_block": Wanted(("knife stand",), (0.05, 0.05, 0.15), (0.3, 0.3, 0.4), max_kb=200),
    "cutting_board": Wanted(("chopping board",), (0.2, 0.15, 0.01), (0.5, 0.4, 0.06), max_kb=200),
    "magazine": Wanted(("book", "newspaper"), (0.15, 0.15, 0.01), (0.35, 0.35, 0.06), max_kb=200),
    "photo": Wanted(("frame chambord", "frame hôi an", "calendar"), (0.08, 0.05, 0.08), (0.25, 0.25, 0.3)),
    "laptop": Wanted(("laptop", "apple ibook"), (0.25, 0.2, 0.2), (0.4, 0.35, 0.35)),
    "remote": Wanted(("tv remote control",), (0.03, 0.1, 0.01), (0.1, 0.25, 0.05)),
    "shoes": Wanted(("slippers", "bootie", "woman shoes", "mocassin"), (0.15, 0.2, 0.05), (0.35, 0.4, 0.3), max_kb=200),
    "cardboard_box": Wanted(("cardboard box", "open cardboard box"), (0.3, 0.2, 0.2), (0.85, 0.65, 0.5)),
    "waste_bin": Wanted(("dustbin", "bullet trash can"), (0.2, 0.2, 0.3), (0.4, 0.4, 0.8)),
    "basket": Wanted(("shopping basket",), (0.3, 0.3, 0.3), (0.65, 0.55, 0.65)),
    "toys": Wanted(("basketball", "soccer ball", "doll house"), (0.1, 0.1, 0.1), (0.75, 0.5, 0.9), max_kb=300),
}

WANTED: dict[str, Wanted] = {
    **_SEATS_AND_BEDS,
    **_TABLES_AND_CABINETS,
    **_KITCHEN_AND_BATHROOM,
    **_LAMPS_AND_PLANTS,
    **_SMALL_THINGS,
}
"""Name of the function that makes a piece by code -> what can stand in its place."""

LEFT_OUT = frozenset(
    {
        "Blend Swap CC-0#bed1",  # too many triangles
        "Blend Swap CC-0#bookcase",  # empty
        "Blend Swap CC-BY#bookcase",  # empty
        "Kator Legaz#utility-shelving",  # for a workshop
        "Scopia#bathroom3",  # glass
        "Scopia#coffee_table",  # glass
        "Scopia#kids_shelves",  # without materials
        "Scopia#kitchenHood",  # cut out by a texture
        "Scopia#table_wood_and_iron",  # glass
        "Scopia#wooden_office_pear_table",  # for a corner
    }
)
"""Models of Debian's sweethome3d-furniture that fit by name and size, and would look wrong."""
