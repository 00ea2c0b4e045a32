"""Names of series and maps, and the units, signs and colours in which they are shown: figures, pages and tables ask here.

Heights are positive toward the other body wherever they are shown, so peaks are high on both bodies, as in ISO 25178-2. The disc's are
the model's z; the z of the pin grows away from the disc, so its sign is changed, and as the pin wears by far more than it is rough, it
is counted from its mean.
"""

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from plateau.units import ICE, Unit, unit_of

NUMBER, PERCENT, METRE, SECOND = Unit("", 1.0), Unit("%", 100.0), Unit("m", 1.0), Unit("s", 1.0)
MICROMETRE, MM2, MM3 = Unit("µm", 1e6), Unit("mm²", 1e6), Unit("mm³", 1e9)
MEGAPASCAL, CELSIUS, KILOJOULE, MICROGRAM = Unit("MPa", 1e-6), Unit("°C", 1.0, -ICE), Unit("kJ", 1e-3), Unit("µg", 1e9)
MILLIGRAM, MG_PER_KM, PER_KM, KILOMETRE = Unit("mg", 1e6), Unit("mg/km", 1e9), Unit("km⁻¹", 1e3), Unit("km", 1e-3)
NEWTON, NEWTON_METRE, RPM, KMH = Unit("N", 1.0), Unit("N m", 1.0), Unit("rpm", 60.0 / math.tau), Unit("km/h", 3.6)


@dataclass(frozen=True)
class Series:
    """A series as it is shown."""

    # Name in run files, title in a few words, and the unit in which numbers of it are given.
    name: str
    title: str
    unit: Unit


# In the order in which they are told.
SERIES = {
    one.name: one
    for one in (
        Series("sliding_distance", "sliding distance", METRE),
        Series("contact_area", "contact area", MM2),
        Series("contact_area_mean", "contact area, mean of the last simulated revolution", MM2),
        Series("contact_ratio", "contact area over the area of the pin", PERCENT),
        Series("mean_pressure", "mean contact pressure", MEGAPASCAL),
        Series("max_pressure", "largest contact pressure", MEGAPASCAL),
        Series("filled_fraction", "disc filled", PERCENT),
        Series("disc_secondary", "disc covered by secondary plateaus", PERCENT),
        Series("pin_secondary", "pin covered by secondary plateaus", PERCENT),
        Series("pin_primary", "pin covered by primary plateaus", PERCENT),
        Series("pin_none", "pin without plateaus", PERCENT),
        Series("worn_pin", "volume worn off plateaus of the simulated pin", MM3),
        Series("worn_resin", "volume worn off the resin of the simulated pin", MM3),
        Series("worn_whole_pin", "volume worn off the whole simulated pin, plateaus and resin", MM3),
        Series("lost_pin", "volume that the whole simulated pin has lost, as a balance shows it", MM3),
        Series("worn_disc", "volume worn off the disc by the simulated pin", MM3),
        Series("emitted", "emitted debris of the simulated pin", MM3),
        Series("deposited_pin", "debris deposited on the pin", MM3),
        Series("deposited_disc", "debris deposited on the disc", MM3),
        Series("pool", "debris in the pool", MM3),
        Series("normal_force", "normal force on the simulated pin", NEWTON),
        Series("rotational_speed", "rotational speed", RPM),
        Series("contact_time", "time in contact", SECOND),
        Series("road_distance", "distance of the vehicle", METRE),
        Series("friction_coefficient", "coefficient of friction", NUMBER),
        Series("friction_coefficient_mean", "coefficient of friction, mean of the last simulated revolution", NUMBER),
        Series("friction_work", "work of friction of the simulated pin", KILOJOULE),
        Series("contact_temperature", "temperature of the contact", CELSIUS),
        Series("contact_temperature_heated", "temperature of the cells in contact, mean", CELSIUS),
        Series("contact_temperature_max", "temperature of the hottest cell of the pin", CELSIUS),
        Series("disc_temperature", "mean temperature of the disc", CELSIUS),
        Series("pin_temperature", "mean temperature of the pin", CELSIUS),
        Series("heat_lost", "heat of the simulated pin lost to air and holder", KILOJOULE),
        Series("heat_residual", "relative residual of the energy balance", NUMBER),
        Series("emitted_mass", "mass of the emitted debris of the simulated pin", MICROGRAM),
        Series("pm10_mass", "mass airborne as PM10, of the simulated pin", MICROGRAM),
        Series("pm25_mass", "mass airborne as PM2.5, of the simulated pin", MICROGRAM),
        Series("particle_number", "airborne particles of the simulated pin", NUMBER),
        Series("brake_torque", "torque of the whole brake", NEWTON_METRE),
        Series("brake_pm10_mass", "mass airborne as PM10, of the whole brake", MILLIGRAM),
        Series("brake_pm25_mass", "mass airborne as PM2.5, of the whole brake", MILLIGRAM),
        Series("brake_emitted_mass", "mass lost by the whole brake", MILLIGRAM),
        Series("brake_particle_number", "airborne particles of the whole brake", NUMBER),
        Series("brake_pm10_per_distance", "PM10 of the whole brake, for the distance of the vehicle", MG_PER_KM),
        Series("brake_pm25_per_distance", "PM2.5 of the whole brake, for the distance of the vehicle", MG_PER_KM),
        Series("brake_emitted_per_distance", "mass lost by the whole brake, for the distance of the vehicle", MG_PER_KM),
        Series("brake_particles_per_distance", "airborne particles of the whole brake, for the distance of the vehicle", PER_KM),
        Series("pad_wear", "thickness lost by the pads", MICROMETRE),
        Series("pad_wear_per_distance", "thickness lost by the pads, for the distance of the vehicle", Unit("mm in 1000 km", 1e9)),
        Series("pad_life", "distance that the pads last", KILOMETRE),
    )
}


def series_of(name: str, si: str = "1", values: Any = ()) -> Series:
    """Series of that name as it is shown; one that has no place in the table by its name, in the unit that suits its largest value."""
    return SERIES.get(name) or Series(name, name.replace("_", " "), unit_of(si, values))


@dataclass(frozen=True)
class Map:
    """A map as it is shown."""

    # Path in run files, but that of the thickness of the debris, which is computed; title, with body and sign; name and unit of its values.
    path: str
    title: str
    what: str
    unit: Unit
    # Colours: by the colour map from nearly the least to nearly the greatest value, from zero on, or by what the cells are.
    colours: Literal["span", "from zero", "statuses"] = "span"
    # True if values are counted from their mean; the sign with which they are shown.
    about_mean: bool = False
    sign: float = 1.0

    @property
    def body(self) -> str:
        """Body of the map, ``"disc"`` or ``"pin"``."""
        return self.path.split("/")[0]

    def shown(self, values: Any) -> Any:
        """Values of one moment, SI, as they are shown: with sign and zero, in the unit; NaN where there is no cell."""
        values = np.where(np.equal(values, ABSENT), np.nan, values) if self.colours == "statuses" else np.asarray(values, float)
        there = np.isfinite(values)
        zero = values[there].mean() if self.about_mean and there.any() else 0.0
        return self.unit.value(self.sign * (values - zero))


MAPS = {
    one.path: one
    for one in (
        Map("disc/height", "Disc: height, positive toward the pin", "height", MICROMETRE),
        Map("disc/substrate", "Disc: height below the debris", "height", MICROMETRE),
        Map("disc/thickness", "Disc: build-up", "thickness", MICROMETRE, "from zero"),
        Map("disc/status", "Disc: status", "status", NUMBER, "statuses"),
        Map("pin/height", "Pin: height, positive toward the disc", "height toward the disc", MICROMETRE, "span", True, -1.0),
        Map("pin/substrate", "Pin: height below the debris, positive toward the disc", "height toward the disc", MICROMETRE, "span", True, -1.0),
        Map("pin/thickness", "Pin: build-up", "thickness", MICROMETRE, "from zero"),
        Map("pin/status", "Pin: status", "status", NUMBER, "statuses"),
        Map("pin/pressure", "Pin: contact pressure", "pressure", MEGAPASCAL, "from zero"),
        Map("pin/temperature", "Pin: contact temperature", "temperature", CELSIUS),
    )
}
# Names of maps in scenes, where they are not those of body and map.
MAP_KEYS = {"pin/pressure": "pressure", "pin/temperature": "contact_temperature"}
# Statuses by their number: what such cells are called, and what they are made of; status of a cell outside a round pin.
ABSENT = 3
STATUSES = [("none", "resin"), ("primary plateau", "fibre, or coating"), ("secondary plateau", "compacted debris")]
