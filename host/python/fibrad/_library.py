# _library.py - libfibrad.so by ctypes: its structures, checked against its own sizes. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import importlib.metadata
import os
import pathlib
from ctypes import POINTER, c_char_p, c_double, c_int, c_size_t, c_ubyte, c_uint32, c_uint64, c_void_p
from typing import Any

DOUBLES = POINTER(c_double)
PROGRESS: Any = ctypes.CFUNCTYPE(c_int, c_void_p, c_char_p, c_uint64, c_uint64)


_structures: list[Any] = []


class _Cylinder(ctypes.Structure):
    _fields_ = [("x", c_double), ("y", c_double), ("radius", c_double), ("axis", c_int)]


def structure_of_files(name: str, *fields: tuple[str, Any]) -> Any:
    """The structure NAME of libfibrad_files.so. Each field is one or more names, separated by blanks, and their
    type."""
    return type(name, (ctypes.Structure,),
                {"_fields_": [(one, kind) for names, kind in fields for one in names.split()]})


def _structure(name: str, *fields: tuple[str, Any]) -> Any:
    """The structure fibrad_NAME of libfibrad.so, with fields as for structure_of_files."""
    structure = structure_of_files(f"fibrad_{name}", *fields)
    _structures.append(structure)
    return structure


Spheres = _structure("spheres", ("x y z r", DOUBLES), ("n stride stride_r", c_uint32), ("id", POINTER(c_uint64)))
Plane = _structure("plane", ("axis upper", c_int), ("at", c_double))
Wall = _structure("wall", ("kind", c_int), ("plane", Plane), ("cylinder", _Cylinder))
Triangles = _structure("triangles", ("x y z", DOUBLES), ("stride vertices", c_uint32),
                       ("corner front back", POINTER(c_uint32)), ("n", c_uint32), ("period", c_double * 3))
SceneConfig = _structure("scene_config", ("isa", c_int), ("period", c_double * 3), ("wall", POINTER(Wall)),
                         ("walls", c_uint32), ("opening", POINTER(Plane)), ("openings", c_uint32),
                         ("known_low known_high", c_double * 3), ("occupancy", c_void_p),
                         ("triangles", POINTER(Triangles)))
Fault = _structure("fault", ("first second triangle wall", c_uint32), ("why", c_int))
SceneFacts = _structure("scene_facts", ("spheres walls", c_uint32), ("isa", c_int), ("cells", c_uint32),
                        ("radius_min radius_max overlap_max", c_double), ("overlap_pair", c_uint32 * 2),
                        ("triangles", c_uint32))
Run = _structure("run", ("threads", c_int), ("progress", PROGRESS), ("context", c_void_p), ("fault", Fault))
BeamRule = _structure("beam_rule", ("directions points", c_uint32), ("cutoff tolerance", c_double), ("turn", c_uint64),
                      ("lines", c_void_p), ("chords", c_uint32))
SurfaceRule = _structure("surface_rule", ("nodes flags", c_uint32), ("cutoff", c_double), ("isa", c_int))
CastRule = _structure("cast_rule", ("rays", c_uint32), ("random", c_int), ("seed", c_uint64), ("cutoff", c_double))
BedOptions = _structure("bed_options", ("beam", POINTER(BeamRule)), ("surface", POINTER(SurfaceRule)),
                        ("cast", POINTER(CastRule)), ("wanted", POINTER(c_ubyte)), ("raw", c_int), ("drop", c_double),
                        ("walls", c_int), ("scratch", c_char_p))
Matrix = _structure("factors", ("n walls", c_uint32), ("start", POINTER(c_uint64)), ("col", POINTER(c_uint32)),
                    ("f escaped beyond error wall wall_wall wall_escaped wall_error", DOUBLES),
                    ("wall_correction wall_closure changed", c_double), ("changed_row", c_uint32))
BedFactors = _structure("bed_factors", ("matrix", Matrix), ("facts", SceneFacts), ("wall_area", DOUBLES),
                        ("threads", c_int), ("directions", c_uint32), ("fallbacks rays", c_uint64),
                        ("seconds closure_error reciprocity_error", c_double))
ExchangeRule = _structure("exchange_rule", ("emissivity wall_emissivity", DOUBLES), ("directions paths", c_uint32),
                          ("seed", c_uint64), ("cutoff tolerance", c_double), ("conductivity node_emissivity", DOUBLES),
                          ("flights", c_uint32), ("known", DOUBLES), ("known_paths", c_double))
Displacement = _structure("displacement", ("square error", c_double * 3), ("absorbed", c_double), ("rays", c_uint64))
HeatConfig = _structure("heat_config", ("directions points patches parts", c_uint32), ("cutoff", c_double),
                        ("wall_rays", c_uint32))
HeatSources = _structure("heat_sources", ("temperature emissivity power hold reference", DOUBLES),
                         ("wall_temperature wall_emissivity wall_power", DOUBLES), ("insulated", POINTER(c_ubyte)),
                         ("surroundings sigma tolerance", c_double), ("sweeps_max", c_uint32), ("uniform", c_int),
                         ("side_temperature light conductivity absorbed", DOUBLES),
                         ("contact_first contact_second", POINTER(c_uint32)), ("conductance", DOUBLES),
                         ("contacts", c_uint32), ("contact_places", DOUBLES))
HeatResult = _structure("heat_result", ("power wall_power", DOUBLES), ("surroundings_power", c_double),
                        ("temperature wall_temperature power_error wall_error", DOUBLES),
                        ("temperature_error wall_temperature_error", DOUBLES),
                        ("error_patches error_beams residual", c_double), ("sweeps", c_uint32),
                        ("wall_absorbed", DOUBLES), ("surroundings_error", c_double), ("wall_area", DOUBLES),
                        ("least_temperature largest_temperature centre_temperature", DOUBLES),
                        ("surface_error centre_error", DOUBLES), ("conducted wall_conducted contact_flow", DOUBLES))
ContactRule = _structure("contact_rule", ("spots", c_int), ("scale gas_reach gas_jump gas_least", c_double),
                         ("gas_alone", c_int))
ContactList = _structure("contact_list", ("n", c_uint32), ("first second", POINTER(c_uint32)),
                         ("distance radius other spot", DOUBLES))

LightStructure = _structure("light", ("direction", c_double * 3), ("flux half_angle", c_double), ("directions", c_uint32),
                            ("shape", c_int), ("centre", c_double * 3), ("radius", c_double),
                            ("low high", c_double * 2))
LightSources = _structure("light_sources", ("light", POINTER(LightStructure)), ("lights", c_uint32),
                          ("absorptivity wall_absorptivity", DOUBLES), ("tolerance", c_double), ("uniform", c_int))
LightResult = _structure("light_result", ("absorbed absorbed_first absorbed_error", DOUBLES),
                         ("wall_absorbed wall_absorbed_first wall_absorbed_error", DOUBLES),
                         ("incident transmitted reflected error error_patches", c_double), ("sweeps lights", c_uint32),
                         ("patches", c_void_p))
TransientConfig = _structure("transient_config", ("method", c_int), ("exchange", ExchangeRule), ("heat", HeatConfig))
Span = _structure("span", ("temperature capacity", DOUBLES), ("duration", c_double),
                  ("wall_temperature surroundings", DOUBLES), ("step tolerance", c_double),
                  ("power wall_power", DOUBLES), ("surroundings_power", c_double), ("wall_energy", DOUBLES),
                  ("surroundings_energy", c_double), ("observe law context", c_void_p), ("error", c_double),
                  ("steps refused sweeps corrections", c_uint64))


def _declare(library: ctypes.CDLL) -> None:
    """Types of what is called, so that no pointer is cut to an int."""
    bed: list[Any] = [POINTER(SceneConfig), POINTER(Spheres)]
    library.fibrad_version.restype = library.fibrad_status_text.restype = library.fibrad_why_text.restype = c_char_p
    library.fibrad_host_sizeof.argtypes, library.fibrad_host_sizeof.restype = [c_char_p], c_size_t
    library.fibrad_node_emissivity.argtypes, library.fibrad_node_emissivity.restype = [c_double, c_double], c_double
    library.fibrad_view_factors.argtypes = [*bed, POINTER(BedOptions), POINTER(Run), POINTER(POINTER(BedFactors))]
    library.fibrad_exchange_factors.argtypes = [*bed, POINTER(ExchangeRule), POINTER(BedOptions), POINTER(Run),
                                                POINTER(POINTER(BedFactors))]
    library.fibrad_displacements.argtypes = [*bed, POINTER(ExchangeRule), POINTER(c_ubyte), POINTER(Run),
                                             c_void_p, c_void_p]
    library.fibrad_radiation_new.argtypes = [POINTER(c_void_p), *bed, POINTER(HeatConfig), POINTER(Run)]
    library.fibrad_radiation_move.argtypes = [c_void_p, *bed]
    library.fibrad_radiation_solve.argtypes = [c_void_p, POINTER(HeatSources), POINTER(HeatResult)]
    library.fibrad_radiation_shine.argtypes = [c_void_p, POINTER(LightSources), POINTER(LightResult)]
    library.fibrad_radiation_sides.argtypes = [c_void_p, DOUBLES, DOUBLES]
    library.fibrad_radiation_describe.argtypes = [c_void_p, c_void_p, POINTER(Fault)]
    library.fibrad_radiation_free.argtypes = [c_void_p]
    library.fibrad_transient_new.argtypes = [POINTER(c_void_p), *bed, POINTER(TransientConfig), POINTER(Run)]
    library.fibrad_transient_move.argtypes = [c_void_p, *bed]
    library.fibrad_transient_advance.argtypes = [c_void_p, POINTER(HeatSources), POINTER(Span)]
    library.fibrad_transient_describe.argtypes = [c_void_p, c_void_p, POINTER(Fault)]
    library.fibrad_transient_free.argtypes = [c_void_p]
    library.fibrad_bed_free.argtypes = [POINTER(BedFactors)]
    library.fibrad_contacts_find.argtypes = [*bed, POINTER(ContactRule), POINTER(POINTER(ContactList))]
    library.fibrad_contacts_conduct.argtypes = [POINTER(ContactList), POINTER(ContactRule), DOUBLES, DOUBLES, DOUBLES]
    library.fibrad_contacts_free.argtypes, library.fibrad_contacts_free.restype = [POINTER(ContactList)], None
    for name in ("radiation_describe", "radiation_free", "transient_describe", "transient_free", "bed_free"):
        getattr(library, f"fibrad_{name}").restype = None


def _load() -> ctypes.CDLL:
    """The library that FIBRAD_LIBRARY names, that of the package, that of the source tree, or that of the system."""
    here = pathlib.Path(__file__).resolve().parent
    named = os.environ.get("FIBRAD_LIBRARY")
    places = [here / "libfibrad.so", here.parents[2] / os.environ.get("BUILD", "build") / "libfibrad.so"]
    path = named or next((str(place) for place in places if place.exists()), "libfibrad.so.1")
    try:
        return ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"fibrad: {path} cannot be loaded: {error}") from None


def _check(library: ctypes.CDLL) -> None:
    """The library must be that of this package: its version, and the sizes of its structures."""
    found = library.fibrad_version().decode()
    try:
        wanted = importlib.metadata.version("fibrad")
    except importlib.metadata.PackageNotFoundError:
        wanted = found  # used from the source tree
    if found != wanted:
        raise ImportError(f"fibrad: {library._name} is of version {found}, this package of {wanted}")
    for kind in _structures:
        size = library.fibrad_host_sizeof(kind.__name__.encode())
        if size != ctypes.sizeof(kind):
            raise ImportError(f"fibrad: {library._name}: {kind.__name__} has {size} bytes, "
                              f"this package has {ctypes.sizeof(kind)}")


library = _load()
_declare(library)
_check(library)
