/* status.c - texts of the status codes, and the version. SPDX-License-Identifier: MIT */
#include "base/port.h"
#include "fibrad.h"

/* Texts stand side by side: tables of their addresses would be data in position independent code. */
static const char status_text[][106] = {
    [-FIBRAD_OK] = "success",
    [-FIBRAD_E_ARGUMENT] = "a null pointer, or a value that is out of its range, not a number or infinite",
    [-FIBRAD_E_SIZE] = "the memory block is too small",
    [-FIBRAD_E_CAPACITY] = "an output is too small",
    [-FIBRAD_E_TABLE] = "that number of samples is not built in",
    [-FIBRAD_E_GEOMETRY] =
        "two spheres have the same centre, the centre of one lies inside another, or one reaches beyond an opening",
    [-FIBRAD_E_WORK] = "the work memory is too small",
    [-FIBRAD_E_STATE] = "a call is missing, too early or repeated, or the scene has changed",
    [-FIBRAD_E_ISA] = "this build or this machine does not have the instruction set",
    [-FIBRAD_E_UNSUPPORTED] = "this version does not compute that",
    [-FIBRAD_E_MEMORY] = "out of memory",
    [-FIBRAD_E_CANCELLED] = "stopped on request",
    [-FIBRAD_E_UNSOLVABLE] = "no temperatures give the powers that were asked for",
    [-FIBRAD_E_BACK] = "a side of a triangle that belongs to no wall was seen",
    [-FIBRAD_E_SUM] = "a row does not add up to 1: a fault of fibrad, please report it",
    [-FIBRAD_E_ENDLESS] = "the walls form a tube or a corner without end: make the missing side a wall or an opening",
    [-FIBRAD_E_FILE] = "a file cannot be made or written",
    [-FIBRAD_E_UNSETTLED] = "the search for radiosities and temperatures does not converge",
};

static const char why_text[][74] = {
    [FIBRAD_WHY_PLACE] = "a coordinate is not a number, or beyond 3e13 smallest radii or 1e150",
    [FIBRAD_WHY_RADIUS] = "the radius is not above 0, or not within 1e-150 to 1e150",
    [FIBRAD_WHY_BEYOND] = "the centre lies beyond a wall",
    [FIBRAD_WHY_WALL] = "contradicts the box or another wall, or its position or size is not valid",
    [FIBRAD_WHY_TEMPERATURE] = "the temperature is out of range",
    [FIBRAD_WHY_EMISSIVITY] = "the emissivity is not within 0 to 1",
    [FIBRAD_WHY_POWER] = "the power is out of range",
    [FIBRAD_WHY_BOTH] = "has both a temperature and a power; give only one of them",
    [FIBRAD_WHY_NEITHER] = "has neither a temperature nor a power",
    [FIBRAD_WHY_REFLECTS] = "has emissivity 0 and cannot give off a power",
    [FIBRAD_WHY_STORAGE] = "hold or reference is out of range",
    [FIBRAD_WHY_ENDLESS] = "is endless and needs a temperature",
    [FIBRAD_WHY_SIDE] = "a triangle's temperature, film or power is wrong, or its wall has none",
    [FIBRAD_WHY_SURROUNDINGS] = "the temperature of the surroundings is missing or out of range",
    [FIBRAD_WHY_SIGMA] = "sigma is out of range",
    [FIBRAD_WHY_TOLERANCE] = "the tolerance is out of range",
    [FIBRAD_WHY_MISSING] = "an array is missing",
    [FIBRAD_WHY_CONDUCTIVITY] = "a conductivity is not above 0",
    [FIBRAD_WHY_CONTACT] = "a contact has an end that is neither a sphere nor a wall",
    [FIBRAD_WHY_CONDUCTANCE] = "a conductance is negative or out of range",
    [FIBRAD_WHY_TOUCHED] = "has a contact or film, but no single temperature",
    [FIBRAD_WHY_FILM] = "its film or the temperature of the gas there is out of range",
    [FIBRAD_WHY_STREAM] = "the stream has no such slice, or its inlet or capacities are out of range",
    [FIBRAD_WHY_CLUMP] = "its clump touches its own image in the periodic box",
    [FIBRAD_WHY_CLUMP_HEAT] = "members of its clump differ in temperature or in what they store",
    [FIBRAD_WHY_CLUMP_SOLID] = "it is a member of a clump and has a finite conductivity",
    [FIBRAD_WHY_CLUMP_LIGHT] = "light on clumps is not computed",
    [FIBRAD_WHY_ALONE] = "nothing that it touches radiates or has a temperature",
    [FIBRAD_WHY_CAPACITY] = "the heat capacity is not above 0 or is out of range",
    [FIBRAD_WHY_LIGHT] = "a number of the light is out of range, or its direction is zero",
    [FIBRAD_WHY_DARK] = "no open face lets the light in",
    [FIBRAD_WHY_FOOTPRINT] = "lies before the disc of the light",
};

const char *fibrad_status_text(int status) {
    const bool known = status <= 0 && status > -(int)(sizeof status_text / sizeof *status_text);
    return known && *status_text[-status] ? status_text[-status] : "no known status";
}

const char *fibrad_why_text(int why) {
    const bool known = why >= 0 && why < (int)(sizeof why_text / sizeof *why_text);
    return known && *why_text[why] ? why_text[why] : "the value is not valid";
}

const char *fibrad_version(void) { return FIBRAD_VERSION; }
