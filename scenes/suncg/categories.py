"""What SUNCG's models are: its metadata/ModelCategoryMapping.csv, where the data root has one."""

import csv
import io

from slamgym.errors import SceneError
from slamgym.scenes.importing.data_root import DataRoot

PATH = "metadata/ModelCategoryMapping.csv"
MODEL, CATEGORY = "model_id", "fine_grained_class"
DOOR = "door"
LAMPS = {"chandelier": 0.3, "ceiling_fan": 0.2, "floor_lamp": 0.9, "table_lamp": 0.75, "wall_lamp": 0.5}
"""Categories of models that give light, and how high in its box the bulb of one is, by the box's height."""


def read_categories(root: DataRoot, defects: list[str]) -> dict[str, str]:
    """Category by a model's id; empty without the file. defects: gets a line when there is one that is of no use."""
    try:
        if not root.path_of(PATH).exists():
            return {}
        rows = csv.DictReader(io.StringIO(root.read(PATH).decode(errors="replace")))
        found = {row[MODEL]: row[CATEGORY] for row in rows if row.get(MODEL) and row.get(CATEGORY)}
    except (SceneError, csv.Error) as error:
        defects.append(f"{PATH}: {error}; it is not used")
        return {}
    if not found:
        defects.append(f"{PATH}: expected the columns {MODEL} and {CATEGORY}, got none; it is not used")
    return found
