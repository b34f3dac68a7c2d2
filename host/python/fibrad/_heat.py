# _heat.py - powers and temperatures of a bed, and what they come from. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import math
from collections.abc import Callable, Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._call import Call
from ._contacts import contacts_of
from ._limits import CAPACITY_MAX, POWER_MAX, SIGMA, TEMPERATURE_MAX
from ._scene import MARKS, WHOLE, Packing, pointer
from ._structures import EmissivityLaw, HeatSources, Law, Store as StoreStructure, Stream
from ._values import doubles, per_sphere, real, refuse
from ._walls import Container, Wall

STEFAN_BOLTZMANN = 5.670374419e-8
"""[W/(m2 K4)]"""

Emissivity = Union[ArrayLike, Callable[[Any], ArrayLike]]
GasFlow = tuple[ArrayLike, ArrayLike]


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Powers:
    """Net powers and temperatures. A net power is above 0 where heat is gained. All net powers add up to 0.

    Attributes
    ----------
    spheres, walls, surroundings
        [W] net power of each sphere (n,), of each wall by name, and of the surroundings.
    temperatures
        [K] (n,) temperature of each sphere, given or found. NaN if the emissivity is 0.
    wall_temperatures
        [K] temperature of each wall by name. For an insulated wall: the fourth root of its mean T**4.
    triangle_fluxes
        [W/m2] (t, 2) net power per area of front and back of each triangle, by the name of the `Mesh`. NaN: the
        side belongs to no wall, or nothing reaches it. Fluxes times areas add up to `walls`, unless a plane or
        the cylinder cuts the mesh.
    triangle_temperatures
        [K] (t, 2) temperature of front and back of each triangle, by the name of the `Mesh`.
    emissivities
        (n,) emissivity of each sphere, at its temperature.
    errors, wall_errors, surroundings_error
        [W] estimated errors of `spheres` (n,), of `walls` by name, and of `surroundings`.
    temperature_errors
        [K] (n,) estimated error of `temperatures`, 0 if the temperature was given.
    least_temperatures, largest_temperatures, centre_temperatures
        [K] (n,) least and largest temperature of the surface of each sphere, and that in its centre. `temperatures` if
        the sphere does not conduct.
    surface_errors, centre_errors
        [K] (n,) estimated errors of least and largest temperatures, and of `centre_temperatures`.
    conducted, convected
        [W] (n,) parts of `spheres` that come through contacts, and from gas. The rest is radiation.
    wall_conducted, wall_convected
        [W] the same parts of `walls`, by name.
    gas, gas_error
        [W] net power of the gas, and its estimated error.
    gas_temperatures
        [K] temperature of each slice of `gas_flow`, from the inlet to the outlet.
    contact_flows
        [W] (m,) what each contact conducts from i to j.
    error, error_patches, error_beams
        [W] estimated error of `spheres`, root mean square, and the parts of it that come from patches and beams.
    residual
        Residual of the radiosities, relative to the differences of emission.
    sweeps
        Sweeps over the beams that the solution took.
    """

    spheres: NDArray[np.float64]
    walls: dict[str, float]
    surroundings: float
    temperatures: NDArray[np.float64]
    wall_temperatures: dict[str, float]
    triangle_fluxes: dict[str, NDArray[np.float64]]
    triangle_temperatures: dict[str, NDArray[np.float64]]
    emissivities: NDArray[np.float64]
    errors: NDArray[np.float64]
    wall_errors: dict[str, float]
    surroundings_error: float
    temperature_errors: NDArray[np.float64]
    least_temperatures: NDArray[np.float64]
    largest_temperatures: NDArray[np.float64]
    centre_temperatures: NDArray[np.float64]
    surface_errors: NDArray[np.float64]
    centre_errors: NDArray[np.float64]
    conducted: NDArray[np.float64]
    wall_conducted: dict[str, float]
    convected: NDArray[np.float64]
    wall_convected: dict[str, float]
    gas: float
    gas_error: float
    gas_temperatures: NDArray[np.float64]
    contact_flows: NDArray[np.float64]
    error: float
    error_patches: float
    error_beams: float
    residual: float
    sweeps: int

    @property
    def balance(self) -> float:
        """[W] sum of all net powers: 0, to rounding."""
        return math.fsum([*self.spheres, *self.walls.values(), self.surroundings, self.gas])

    def __repr__(self) -> str:
        known = self.temperatures[~np.isnan(self.temperatures)]
        range_of = f" of {known.min():.6g} to {known.max():.6g} K" if known.size else ""
        outside = "".join(f", {name} {power:.6g} W" for name, power in [*self.walls.items(), ("surroundings", self.surroundings)])
        return (f"<fibrad.Powers: {len(self.spheres)} spheres{range_of} {math.fsum(self.spheres):.6g} W{outside}; "
                f"error of a sphere {self.error:.2g} W>")


@dataclasses.dataclass(frozen=True, eq=False)
class Store:
    """What a material stores, for `Bed.advance`. The capacities of spheres are then masses [kg].

    Attributes
    ----------
    temperature, capacity
        [K] rows of a table, ascending, and [J/(kg K)] the heat capacity at these, linear in between. No temperature may
        leave them, unless there is one row.
    melting, width
        [K] melting point, or the middle and the width of the range in which the material melts.
    latent
        [J/kg] latent heat. 0: nothing melts.
    """

    temperature: ArrayLike = (1.0,)
    capacity: ArrayLike = (1.0,)
    melting: float = 0.0
    latent: float = 0.0
    width: float = 0.0


def stores_of(stores: Sequence[Store]) -> tuple[Any, Any]:
    """Structures of stores, and arrays that must stay as long as they."""
    arrays = [(doubles("temperature of a Store", one.temperature).ravel(), doubles("capacity of a Store", one.capacity).ravel())
              for one in stores]
    for kelvins, values in arrays:
        good = kelvins.size == values.size > 0 and (np.diff(kelvins) > 0).all()
        if not good or not ((values > 0) & (values <= CAPACITY_MAX)).all() or not (kelvins >= 0).all():
            raise refuse("a Store needs as many capacities, above 0, as temperatures, which ascend")
    for one in stores:
        if not (one.latent >= 0 and one.width >= 0) or one.latent > 0 and not one.melting > one.width / 2:
            raise refuse("a Store needs latent and width of 0 or more, and melting above half of the width")
    return (StoreStructure * len(stores))(*(
        StoreStructure(pointer(kelvins), pointer(values), kelvins.size, one.melting, one.latent, one.width)
        for one, (kelvins, values) in zip(stores, arrays))), arrays


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Advance:
    """The result of a span of time. An energy is above 0 where heat was gained. The heat stored in the spheres, and the
    energies of walls, surroundings, gas and held spheres, add up to the energy that the powers have supplied.

    Attributes
    ----------
    temperatures
        [K] (n,) temperatures of the spheres at the end.
    spheres
        [W] (n,) net radiative power of each sphere at the end.
    walls, surroundings, gas, held
        [J] energy that each wall by name, the surroundings, the gas of `convection`, and spheres of infinite capacity have
        gained.
    gas_temperatures
        [K] temperature of each slice of `gas_flow` at the end.
    stored
        [J] (n,) heat that each sphere has stored.
    melted
        (n,) fraction of each sphere that has melted.
    wall_temperatures
        [K] temperatures of walls at the end, by name. NaN: that of a wall that stores no heat, and is found.
    triangle_energies, triangle_temperatures
        [J] and [K] (t, 2) energy that front and back of each triangle have gained, and their temperatures at the end, by
        the name of the `Mesh`. Empty: no triangle has a film or a power behind it.
    steps, refused
        Steps that were taken, and steps tried and refused.
    corrections
        Solutions by patches that corrected the exchange factors.
    error
        Largest estimated error of a step, relative to a temperature.
    """

    temperatures: NDArray[np.float64]
    spheres: NDArray[np.float64]
    walls: dict[str, float]
    surroundings: float
    gas: float
    gas_temperatures: NDArray[np.float64]
    held: float
    stored: NDArray[np.float64]
    melted: NDArray[np.float64]
    wall_temperatures: dict[str, float]
    triangle_energies: dict[str, NDArray[np.float64]]
    triangle_temperatures: dict[str, NDArray[np.float64]]
    steps: int
    refused: int
    corrections: int
    error: float

    def __repr__(self) -> str:
        range_of = f" of {self.temperatures.min():.6g} to {self.temperatures.max():.6g} K" if self.temperatures.size else ""
        gained = ", ".join(f"{name} {energy:.6g} J" for name, energy in [*self.walls.items(), ("surroundings", self.surroundings)])
        return (f"<fibrad.Advance: {len(self.temperatures)} spheres{range_of}; {gained}; {self.steps} steps, error of a "
                f"step {self.error:.2g}>")


class Sources:
    """A fibrad_heat_sources, its arrays, and the law of emissivities."""

    def __init__(self, packing: Packing, container: Container, walls: list[Wall], surroundings: Optional[float],
                 sigma: float, tolerance: Optional[float], contacts: Any, conductivity: Optional[ArrayLike],
                 convection: Optional[ArrayLike], gas: Optional[ArrayLike], flow: Optional[GasFlow],
                 area: NDArray[np.float64], area_of: Callable[[int], float]):
        n, names, self._packing = packing.n, packing.names, packing
        if surroundings is None and not container.closed():
            raise refuse("surroundings is missing: the temperature [K] of what radiation meets that leaves the bed")
        self.joined = contacts_of(contacts, n, container)
        self.wall_temperature, self._sides = container.temperatures(walls)
        self.behind = container.sides(walls)
        behind: Any = (None, None, None) if self.behind is None else self.behind
        self._wall_emissivity = container.emissivities(walls)
        self.insulated = np.array(["insulated" in one.values for one in walls], np.uint8)
        self._conducts = (None if conductivity is None else
                          per_sphere("conductivity", conductivity, n, 5e-324, math.inf, names))
        if (convection is None) != (gas is None):
            raise refuse("convection and gas_temperature need each other")
        self._film = None if convection is None else per_sphere("convection", convection, n, 0, 1e12, names) * area
        self.gas = None if gas is None else per_sphere("gas_temperature", gas, n, 0, TEMPERATURE_MAX, names)
        self._wall_film, self._wall_gas = container.films(walls, area_of)
        self._set_stream(flow, gas)
        self.c = HeatSources(
            film=pointer(self._film), gas=pointer(self.gas), stream=self._stream, wall_film=pointer(self._wall_film), wall_gas=pointer(self._wall_gas),
            surroundings=real("surroundings", surroundings, 0, TEMPERATURE_MAX), sigma=real("sigma", sigma, *SIGMA),
            tolerance=real("tolerance", tolerance, 0, 1), conductivity=pointer(self._conducts),
            wall_temperature=pointer(self.wall_temperature), wall_emissivity=pointer(self._wall_emissivity),
            insulated=pointer(self.insulated, MARKS), side_temperature=pointer(self._sides),
            side_film=pointer(behind[0]), side_gas=pointer(behind[1]), side_power=pointer(behind[2]),
            contacts=self.joined.conductance.size, conductance=pointer(self.joined.conductance),
            contact_first=pointer(self.joined.first, WHOLE), contact_second=pointer(self.joined.second, WHOLE))
        self._around = surroundings or 300.0
        self.set_wall_power(container.powers(walls))

    def _set_stream(self, flow: Optional[GasFlow], inlet: Optional[ArrayLike]) -> None:
        """Sets the stream of gas, and room for its temperatures."""
        self.gas_temperatures, self._stream = np.zeros(0), None
        if flow is None:
            return
        if inlet is None or np.ndim(inlet) > 0:
            raise refuse("gas_flow needs convection, and gas_temperature is one number, that of the inlet")
        slices = np.asarray(flow[0])
        if slices.shape != (self._packing.n,) or slices.dtype.kind not in "iu" or np.any(slices < 0):
            raise refuse(f"gas_flow: slices must be ({self._packing.n},) whole numbers from 0 on")
        self._slices = slices.astype(np.uint32)
        rates = np.array([[300.0, flow[1]]]) if np.ndim(flow[1]) == 0 else np.asarray(flow[1], float)
        if rates.ndim != 2 or rates.shape[1] != 2:
            raise refuse("gas_flow: the rate must be a number [W/K] or (m, 2) temperatures and rates")
        self._rates = np.ascontiguousarray(rates.T)
        count = int(slices.max(initial=0)) + 1
        memory = np.zeros((4, count))
        self.gas_temperatures = memory[0]
        self._stream = ctypes.pointer(Stream(
            slice=pointer(self._slices, WHOLE), at=pointer(self._rates[0]), capacity=pointer(self._rates[1]), slices=count,
            points=len(rates), inlet=float(inlet), gas=pointer(memory)))

    def has_sides(self, sides: Optional[NDArray[np.float64]]) -> bool:
        """Whether these are the temperatures of the sides of triangles."""
        if sides is None or self._sides is None:
            return sides is self._sides
        return np.array_equal(sides, self._sides, equal_nan=True)

    def set_power(self, power: Optional[NDArray[np.float64]]) -> None:
        self._power, self.c.power = power, pointer(power)

    def set_wall_power(self, power: Optional[NDArray[np.float64]]) -> None:
        self.wall_power, self.c.wall_power = power, pointer(power)

    def set_emissivity(self, emissivity: Emissivity, kelvins: NDArray[np.float64], call: Call) -> Optional[Law]:
        """Sets emissivities. The law of those that follow temperatures; None: they are constant."""
        n, names = self._packing.n, self._packing.names
        first = np.where(np.isnan(kelvins), self._around, kelvins)

        def at(temperatures: NDArray[np.float64]) -> NDArray[np.float64]:
            given = emissivity(temperatures) if callable(emissivity) else emissivity
            return per_sphere("emissivity", given, n, 0, 1, names)

        def follow(context: Any, temperature: Any, of_walls: Any, shares: Any, shares_of_walls: Any) -> None:
            if not n:
                return
            now, to = np.ctypeslib.as_array(temperature, (n,)), np.ctypeslib.as_array(shares, (n,))
            known = ~np.isnan(now)
            to[known] = call.guarded(lambda: at(np.where(known, now, first)), to)[known]

        self.emissivity = at(first).copy()
        self.c.emissivity = pointer(self.emissivity)
        if not callable(emissivity):
            return None
        return Law(follow=EmissivityLaw(follow), emissivity=pointer(self.emissivity),
                   wall_emissivity=pointer(self._wall_emissivity))


def power_of(power: Optional[ArrayLike], kelvins: NDArray[np.float64],
             packing: Packing) -> Optional[NDArray[np.float64]]:
    """[n] given powers. One number holds for all spheres of unknown temperature."""
    if power is None:
        return None
    powers = per_sphere("power", power, packing.n, -POWER_MAX, POWER_MAX, packing.names, True)
    if np.any(powers) and packing.n and not np.isnan(kelvins).any():
        raise refuse("power is given, and all spheres have temperatures; NaN is an unknown one")
    return powers if np.ndim(power) else np.where(np.isnan(kelvins), powers, math.nan)
