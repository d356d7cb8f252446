"""A plant in the loop put together: aircraft, place, sensors, channels, from what the user has asked for."""

from __future__ import annotations

import contextlib
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from offboard.frames import MapFrame
from offboard.hil.channels import Airframe, load_airframe
from offboard.hil.errors import OptionError
from offboard.hil.faults import FAULTS, parse_faults
from offboard.hil.geodesy import Geodesy
from offboard.hil.json_bridge import KNOWN_FAULTS, JsonBridge
from offboard.hil.magnetic import MagneticField
from offboard.hil.pipes import UdpPort
from offboard.hil.plant import HilPlant
from offboard.hil.px4_bridge import Px4Bridge
from offboard.hil.px4_protocol import Px4Link
from offboard.hil.sensors import SensorModel, Sensors
from offboard.hil.simulation import LaunchRule, Simulation

AIRFRAMES = {"px4": "px4-10041", "ardupilot": "ardupilot-plane"}
"""Channels unless others are asked for."""


@dataclass(frozen=True, slots=True)
class HilOptions:
    """What a user can choose; angles and units as on the command line are already converted."""

    autopilot: str = "px4"
    """"px4" or "ardupilot"."""
    aircraft: str = "skywalker_x8"
    """A parameter set, or a TOML file: of parameters, or the mapping of a user's own FMU."""
    airframe: str | None = None
    """Order of the channels; the autopilot's usual one if not given."""
    launch: str = "runway"
    """"runway", "catapult" or "air"."""
    rule: LaunchRule = field(default_factory=LaunchRule)
    """When it is let go."""
    wind: tuple[float, float] = (0.0, 0.0)
    """Velocity of the air over ground, north and east [m/s]."""
    faults: str = ""
    """Failures of sensors, in their text form."""
    home: MapFrame = field(default_factory=lambda: MapFrame(47.397742, 8.545594, 488.0))
    """Where the flight begins; PX4's and ArduPilot's customary place."""
    heading: float = 0.0
    """Of runway or catapult [rad]."""
    start: datetime = datetime(2025, 6, 21, 8, tzinfo=UTC)
    """When, for the sun and the magnetic field."""
    sensors: SensorModel = field(default_factory=SensorModel)
    """Noise, bias, timing."""
    seed: int = 1
    """Of all noise."""
    values: Mapping[str, float] = field(default_factory=dict)
    """Variables of the model, by name."""


class Rig:
    """Plant, map and channels for one run; a context manager, for it holds the FMU.

    Raises
    ------
    OptionError
        If something asked for does not exist or makes no sense.
    """

    def __init__(self, options: HilOptions) -> None:
        self.options = options
        known = KNOWN_FAULTS if options.autopilot == "ardupilot" else FAULTS
        self.faults = parse_faults(options.faults, known)
        self.airframe: Airframe = load_airframe(options.airframe or AIRFRAMES[options.autopilot])
        if self.airframe.autopilot != options.autopilot:
            raise OptionError("--airframe", [f"{self.airframe.name!r} is for {self.airframe.autopilot}"])
        self.geodesy = Geodesy(options.home)
        self._stack = contextlib.ExitStack()
        try:
            self.plant: HilPlant = self._plant()
        except BaseException:
            self._stack.close()
            raise
        self.simulation = Simulation(self.plant, options.rule)

    def json_bridge(self, port: UdpPort) -> JsonBridge:
        """The plant behind ArduPilot."""
        return JsonBridge(self.simulation, port, self.airframe, self.geodesy, self.faults)

    def px4_bridge(self, speed: float) -> Px4Bridge:
        """The plant behind PX4, at a speed in times real time; 0: as fast as PX4 answers."""
        rng = np.random.default_rng(self.options.seed)
        field_model = MagneticField(self.options.start)
        sensors = Sensors(self.geodesy, field_model, rng, self.options.sensors, self.faults)
        return Px4Bridge(self.simulation, sensors, self.airframe, Px4Link(), speed=speed)

    @property
    def declination(self) -> float:
        """Of the magnetic field at home [rad]."""
        home = self.options.home
        return (
            MagneticField(self.options.start)
            .at(home.latitude_deg, home.longitude_deg, home.altitude_m)
            .declination
        )

    def _plant(self) -> HilPlant:
        options = self.options
        if (mapping := _mapping(options.aircraft)) is not None:
            return self._own_fmu(mapping)
        from fmu.library import FmuLibrary  # noqa: PLC0415
        from scenarios.hil_plant import FmuHilPlant  # noqa: PLC0415

        home = options.home
        place = {
            "environment.latitude": math.radians(home.latitude_deg),
            "environment.longitude": math.radians(home.longitude_deg),
            "environment.start_time": options.start.timestamp(),
        }
        library = self._stack.enter_context(FmuLibrary.open())
        return self._stack.enter_context(
            FmuHilPlant(
                library,
                aircraft=options.aircraft,
                launch=options.launch,
                heading=options.heading,
                home_elevation=home.altitude_m,
                wind=options.wind,
                values={**place, **options.values},
            )
        )

    def _own_fmu(self, mapping: Path) -> HilPlant:
        from scenarios.hil_mapped import MappedHilPlant, load_hil_mapping  # noqa: PLC0415

        options = self.options
        plant = MappedHilPlant(
            load_hil_mapping(mapping), options.home.altitude_m, options.wind, options.values
        )
        return self._stack.enter_context(plant)

    def close(self) -> None:
        """Free the FMU."""
        self._stack.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _mapping(aircraft: str) -> Path | None:
    """The file, if it maps a user's own FMU; a file that cannot be read is left to who reads it next."""
    if not aircraft.endswith(".toml"):
        return None
    document: Mapping[str, Any] = {}
    with contextlib.suppress(OSError, tomllib.TOMLDecodeError, UnicodeDecodeError):
        document = tomllib.loads(Path(aircraft).read_text(encoding="utf-8"))
    return Path(aircraft) if "fmu" in document else None
