"""The aircraft: a fixed-wing model in C, packaged as an FMU and stepped with fmpy."""

from fmu.errors import AircraftError, BuildError, FmuError, PlantError
from fmu.library import FmuLibrary
from fmu.parameters import aircraft_names, load_aircraft
from fmu.plant import FmuPlant
from fmu.saving import SavedPlant
from fmu.types import PlantLimits, PlantState

__all__ = [
    "AircraftError",
    "BuildError",
    "FmuError",
    "FmuLibrary",
    "FmuPlant",
    "PlantError",
    "PlantLimits",
    "PlantState",
    "SavedPlant",
    "aircraft_names",
    "load_aircraft",
]
