# _structures.py - structures and functions of libfibrad.so, by `make structures`. SPDX-License-Identifier: MIT
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int, c_size_t, c_ubyte, c_uint32,
                    c_uint64, c_void_p)
from typing import Any

Progress: Any = CFUNCTYPE(c_int, c_void_p, c_char_p, c_uint64, c_uint64)
EmissivityLaw: Any = CFUNCTYPE(None, c_void_p, POINTER(c_double), POINTER(c_double), POINTER(c_double),
        POINTER(c_double))
Observe: Any = CFUNCTYPE(None, c_void_p, c_double, POINTER(c_double))


class Stream(Structure):
    _fields_ = [("slice", POINTER(c_uint32)), ("at", POINTER(c_double)), ("capacity", POINTER(c_double)),
                ("slices", c_uint32), ("points", c_uint32), ("inlet", c_double), ("gas", POINTER(c_double))]


class HeatSources(Structure):
    _fields_ = [("temperature", POINTER(c_double)), ("emissivity", POINTER(c_double)), ("power", POINTER(c_double)),
                ("storage", POINTER(c_double)), ("reference", POINTER(c_double)),
                ("wall_temperature", POINTER(c_double)), ("wall_emissivity", POINTER(c_double)),
                ("wall_power", POINTER(c_double)), ("insulated", POINTER(c_ubyte)), ("surroundings", c_double),
                ("sigma", c_double), ("tolerance", c_double), ("sweeps_max", c_uint32), ("no_errors", c_uint32),
                ("side_temperature", POINTER(c_double)), ("side_film", POINTER(c_double)),
                ("side_gas", POINTER(c_double)), ("side_power", POINTER(c_double)), ("light", POINTER(c_double)),
                ("conductivity", POINTER(c_double)), ("absorbed", POINTER(c_double)),
                ("contact_first", POINTER(c_uint32)), ("contact_second", POINTER(c_uint32)),
                ("conductance", POINTER(c_double)), ("contacts", c_uint32), ("contact_temperature", POINTER(c_double)),
                ("film", POINTER(c_double)), ("gas", POINTER(c_double)), ("wall_film", POINTER(c_double)),
                ("wall_gas", POINTER(c_double)), ("stream", POINTER(Stream)), ("contact_places", POINTER(c_double))]


class Plane(Structure):
    _fields_ = [("axis", c_int), ("upper", c_int), ("at", c_double)]


class Cylinder(Structure):
    _fields_ = [("x", c_double), ("y", c_double), ("radius", c_double), ("along", c_int)]


class Wall(Structure):
    _fields_ = [("kind", c_int), ("plane", Plane), ("cylinder", Cylinder)]


class Occupancy(Structure):
    _fields_ = [("low", c_double * 3), ("high", c_double * 3), ("cells", c_uint32 * 3), ("periodic", c_int * 3),
                ("mark", POINTER(c_uint64))]


class Triangles(Structure):
    _fields_ = [("x", POINTER(c_double)), ("y", POINTER(c_double)), ("z", POINTER(c_double)), ("stride", c_uint32),
                ("vertices", c_uint32), ("corner", POINTER(c_uint32)), ("front", POINTER(c_uint32)),
                ("back", POINTER(c_uint32)), ("n", c_uint32), ("period", c_double * 3)]


class SceneConfig(Structure):
    _fields_ = [("isa", c_int), ("period", c_double * 3), ("wall", POINTER(Wall)), ("walls", c_uint32),
                ("opening", POINTER(Plane)), ("openings", c_uint32), ("occupancy", POINTER(Occupancy)),
                ("triangles", POINTER(Triangles))]


class Spheres(Structure):
    _fields_ = [("x", POINTER(c_double)), ("y", POINTER(c_double)), ("z", POINTER(c_double)), ("r", POINTER(c_double)),
                ("n", c_uint32), ("stride", c_uint32), ("stride_r", c_uint32), ("id", POINTER(c_uint64)),
                ("clump", POINTER(c_uint32))]


class Fault(Structure):
    _fields_ = [("first", c_uint32), ("second", c_uint32), ("triangle", c_uint32), ("wall", c_uint32), ("why", c_int)]


class Run(Structure):
    _fields_ = [("threads", c_int), ("progress", Progress), ("context", c_void_p), ("fault", Fault)]


class SceneFacts(Structure):
    _fields_ = [("spheres", c_uint32), ("walls", c_uint32), ("isa", c_int), ("cells", c_uint32),
                ("radius_min", c_double), ("radius_max", c_double), ("overlap_max", c_double),
                ("overlap_pair", c_uint32 * 2), ("triangles", c_uint32), ("clumps", c_uint32), ("covered", c_uint32),
                ("covered_sphere", c_uint32), ("parted", c_uint32), ("parted_pair", c_uint32 * 2)]


class Warning(Structure):
    _fields_ = [("code", c_int), ("first", c_uint32), ("second", c_uint32), ("wall", c_uint32), ("count", c_uint32),
                ("value", c_double), ("other", c_double)]


class BeamRule(Structure):
    _fields_ = [("directions", c_uint32), ("points", c_uint32), ("cutoff", c_double), ("tolerance", c_double),
                ("turn", c_uint64), ("lines", c_void_p), ("chords", c_uint32)]


class CastRule(Structure):
    _fields_ = [("rays", c_uint32), ("random", c_int), ("seed", c_uint64), ("cutoff", c_double)]


class ExchangeRule(Structure):
    _fields_ = [("emissivity", POINTER(c_double)), ("wall_emissivity", POINTER(c_double)), ("directions", c_uint32),
                ("paths", c_uint32), ("seed", c_uint64), ("cutoff", c_double), ("tolerance", c_double),
                ("node_emissivity", POINTER(c_double)), ("open_error", c_double), ("conductivity", POINTER(c_double)),
                ("known", POINTER(c_double)), ("known_paths", c_double)]


class BedRule(Structure):
    _fields_ = [("beam", POINTER(BeamRule)), ("cast", POINTER(CastRule)), ("exchange", POINTER(ExchangeRule)),
                ("wanted", POINTER(c_ubyte)), ("raw", c_int), ("drop", c_double), ("walls", c_int),
                ("scratch", c_char_p)]


class Factors(Structure):
    _fields_ = [("n", c_uint32), ("walls", c_uint32), ("start", POINTER(c_uint64)), ("col", POINTER(c_uint32)),
                ("f", POINTER(c_double)), ("escaped", POINTER(c_double)), ("beyond", POINTER(c_double)),
                ("error", POINTER(c_double)), ("wall", POINTER(c_double)), ("wall_wall", POINTER(c_double)),
                ("wall_escaped", POINTER(c_double)), ("wall_error", POINTER(c_double)), ("wall_correction", c_double),
                ("wall_closure", c_double), ("changed", c_double), ("changed_row", c_uint32)]


class BedMatrix(Structure):
    _fields_ = [("matrix", Factors), ("facts", SceneFacts), ("body", POINTER(c_uint32)), ("area", POINTER(c_double)),
                ("wall_area", POINTER(c_double)), ("threads", c_int), ("directions", c_uint32), ("fallbacks", c_uint64),
                ("rays", c_uint64), ("seconds", c_double), ("closure_error", c_double), ("reciprocity_error", c_double)]


class WallRule(Structure):
    _fields_ = [("emissivity", POINTER(c_double)), ("wall_emissivity", POINTER(c_double)),
                ("node_emissivity", POINTER(c_double)), ("conductivity", POINTER(c_double)), ("paths", c_uint32),
                ("seed", c_uint64)]


class WallRow(Structure):
    _fields_ = [("wall", c_double * 32), ("spheres", c_double), ("escaped", c_double), ("error", c_double),
                ("rays", c_uint64), ("paths", c_uint64)]


class HeatConfig(Structure):
    _fields_ = [("directions", c_uint32), ("points", c_uint32), ("patches", c_uint32), ("parts", c_uint32),
                ("wall_rays", c_uint32)]


class Law(Structure):
    _fields_ = [("follow", EmissivityLaw), ("context", c_void_p), ("emissivity", POINTER(c_double)),
                ("wall_emissivity", POINTER(c_double))]


class HeatResult(Structure):
    _fields_ = [("power", POINTER(c_double)), ("wall_power", POINTER(c_double)), ("surroundings_power", c_double),
                ("temperature", POINTER(c_double)), ("wall_temperature", POINTER(c_double)),
                ("power_error", POINTER(c_double)), ("wall_error", POINTER(c_double)),
                ("temperature_error", POINTER(c_double)), ("wall_temperature_error", POINTER(c_double)),
                ("error_patches", c_double), ("error_beams", c_double), ("residual", c_double), ("sweeps", c_uint32),
                ("wall_absorbed", POINTER(c_double)), ("surroundings_error", c_double),
                ("wall_area", POINTER(c_double)), ("least_temperature", POINTER(c_double)),
                ("largest_temperature", POINTER(c_double)), ("centre_temperature", POINTER(c_double)),
                ("surface_error", POINTER(c_double)), ("centre_error", POINTER(c_double)), ("gas_power", c_double),
                ("gas_error", c_double), ("convected", POINTER(c_double)), ("wall_convected", POINTER(c_double)),
                ("conducted", POINTER(c_double)), ("wall_conducted", POINTER(c_double)),
                ("contact_flow", POINTER(c_double)), ("contact_error", POINTER(c_double))]


class Light(Structure):
    _fields_ = [("direction", c_double * 3), ("flux", c_double), ("half_angle", c_double), ("directions", c_uint32),
                ("shape", c_int), ("centre", c_double * 3), ("radius", c_double), ("low", c_double * 2),
                ("high", c_double * 2)]


class LightSources(Structure):
    _fields_ = [("light", POINTER(Light)), ("lights", c_uint32), ("absorptivity", POINTER(c_double)),
                ("wall_absorptivity", POINTER(c_double)), ("tolerance", c_double)]


class LightResult(Structure):
    _fields_ = [("absorbed", POINTER(c_double)), ("absorbed_first", POINTER(c_double)),
                ("absorbed_error", POINTER(c_double)), ("wall_absorbed", POINTER(c_double)),
                ("wall_absorbed_first", POINTER(c_double)), ("wall_absorbed_error", POINTER(c_double)),
                ("incident", c_double), ("transmitted", c_double), ("reflected", c_double), ("error", c_double),
                ("error_patches", c_double), ("sweeps", c_uint32), ("lights", c_uint32), ("patches", POINTER(c_double))]


class Store(Structure):
    _fields_ = [("temperature", POINTER(c_double)), ("capacity", POINTER(c_double)), ("rows", c_uint32),
                ("melting", c_double), ("latent", c_double), ("width", c_double)]


class Span(Structure):
    _fields_ = [("temperature", POINTER(c_double)), ("capacity", POINTER(c_double)), ("duration", c_double),
                ("store", POINTER(Store)), ("store_of", POINTER(c_uint32)), ("stores", c_uint32),
                ("melted", POINTER(c_double)), ("wall_capacity", POINTER(c_double)), ("wall_end", POINTER(c_double)),
                ("wall_temperature", POINTER(c_double)), ("surroundings", POINTER(c_double)),
                ("gas", POINTER(c_double)), ("wall_gas", POINTER(c_double)), ("side_temperature", POINTER(c_double)),
                ("side_gas", POINTER(c_double)), ("contact_temperature", POINTER(c_double)),
                ("inlet", POINTER(c_double)), ("step", c_double), ("tolerance", c_double), ("power", POINTER(c_double)),
                ("wall_power", POINTER(c_double)), ("surroundings_power", c_double), ("wall_energy", POINTER(c_double)),
                ("surroundings_energy", c_double), ("gas_power", c_double), ("gas_energy", c_double),
                ("held_energy", c_double), ("convected_energy", POINTER(c_double)),
                ("contact_energy", POINTER(c_double)), ("side_energy", POINTER(c_double)),
                ("side_end", POINTER(c_double)), ("stored", POINTER(c_double)), ("law", POINTER(Law)),
                ("observe", Observe), ("context", c_void_p), ("error", c_double), ("steps", c_uint64),
                ("refused", c_uint64), ("sweeps", c_uint64), ("corrections", c_uint64)]


class ContactRule(Structure):
    _fields_ = [("spots", c_int), ("scale", c_double), ("gas_reach", c_double), ("gas_jump", c_double),
                ("gas_least", c_double), ("wall", c_double), ("gas_alone", c_int)]


class ContactList(Structure):
    _fields_ = [("n", c_uint32), ("first", POINTER(c_uint32)), ("second", POINTER(c_uint32)),
                ("distance", POINTER(c_double)), ("radius", POINTER(c_double)), ("other", POINTER(c_double)),
                ("spot", POINTER(c_double))]


STRUCTURES: dict[str, Any] = {
    "fibrad_stream": Stream, "fibrad_heat_sources": HeatSources, "fibrad_plane": Plane, "fibrad_cylinder": Cylinder,
    "fibrad_wall": Wall, "fibrad_occupancy": Occupancy, "fibrad_triangles": Triangles,
    "fibrad_scene_config": SceneConfig, "fibrad_spheres": Spheres, "fibrad_fault": Fault, "fibrad_run": Run,
    "fibrad_scene_facts": SceneFacts, "fibrad_warning": Warning, "fibrad_beam_rule": BeamRule,
    "fibrad_cast_rule": CastRule, "fibrad_exchange_rule": ExchangeRule, "fibrad_bed_rule": BedRule,
    "fibrad_factors": Factors, "fibrad_bed_matrix": BedMatrix, "fibrad_wall_rule": WallRule, "fibrad_wall_row": WallRow,
    "fibrad_heat_config": HeatConfig, "fibrad_law": Law, "fibrad_heat_result": HeatResult, "fibrad_light": Light,
    "fibrad_light_sources": LightSources, "fibrad_light_result": LightResult, "fibrad_store": Store,
    "fibrad_span": Span, "fibrad_contact_rule": ContactRule, "fibrad_contact_list": ContactList}

# what a function returns, and its arguments
FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "fibrad_status_text": (c_char_p, [c_int]),
    "fibrad_version": (c_char_p, []),
    "fibrad_why_text": (c_char_p, [c_int]),
    "fibrad_node_emissivity": (c_double, [c_double, c_double]),
    "fibrad_heat_sources_init": (None, [POINTER(HeatSources)]),
    "fibrad_bed_new": (c_int, [POINTER(c_void_p), POINTER(SceneConfig), POINTER(Spheres), POINTER(Run)]),
    "fibrad_bed_move": (c_int, [c_void_p, POINTER(SceneConfig), POINTER(Spheres)]),
    "fibrad_bed_describe": (None, [c_void_p, POINTER(SceneFacts), POINTER(Fault)]),
    "fibrad_bed_warnings": (c_uint32, [c_void_p, POINTER(Warning)]),
    "fibrad_bed_bodies": (c_uint32, [c_void_p, POINTER(c_uint32)]),
    "fibrad_bed_surfaces": (c_int, [c_void_p, POINTER(c_double), POINTER(c_double)]),
    "fibrad_bed_free": (None, [c_void_p]),
    "fibrad_bed_factors": (c_int, [c_void_p, POINTER(BedRule), POINTER(POINTER(BedMatrix))]),
    "fibrad_bed_matrix_free": (None, [POINTER(BedMatrix)]),
    "fibrad_view_factors": (c_int, [POINTER(SceneConfig), POINTER(Spheres), POINTER(BedRule), POINTER(Run),
        POINTER(POINTER(BedMatrix))]),
    "fibrad_bed_wall_area": (c_double, [c_void_p, c_uint32]),
    "fibrad_bed_wall_row": (c_int, [c_void_p, c_uint32, POINTER(WallRule), c_double, POINTER(WallRow)]),
    "fibrad_bed_beams": (c_int, [c_void_p, POINTER(HeatConfig)]),
    "fibrad_bed_solve": (c_int, [c_void_p, POINTER(HeatSources), POINTER(Law), POINTER(HeatResult)]),
    "fibrad_bed_sides": (c_int, [c_void_p, POINTER(c_double), POINTER(c_double)]),
    "fibrad_bed_shine": (c_int, [c_void_p, POINTER(LightSources), POINTER(LightResult)]),
    "fibrad_bed_advance": (c_int, [c_void_p, POINTER(HeatSources), POINTER(Span)]),
    "fibrad_bed_contacts": (c_int, [c_void_p, POINTER(ContactRule), POINTER(POINTER(ContactList))]),
    "fibrad_contacts_conduct": (c_int, [POINTER(ContactList), POINTER(ContactRule), POINTER(c_double),
        POINTER(c_double), POINTER(c_double)]),
    "fibrad_heap_resize": (c_void_p, [c_void_p, c_void_p, c_size_t]),
    "fibrad_host_sizeof": (c_size_t, [c_char_p]),
}
