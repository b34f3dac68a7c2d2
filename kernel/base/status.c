/* status.c - texts of the status codes, and the version. SPDX-License-Identifier: MIT */
#include "fibrad.h"

const char *fibrad_status_text(int status) {
    switch (status) {
    case FIBRAD_OK:
        return "success";
    case FIBRAD_E_ARGUMENT:
        return "a null pointer, or a value that is out of its range, not a number or infinite";
    case FIBRAD_E_SIZE:
        return "the memory block is too small";
    case FIBRAD_E_CAPACITY:
        return "an output is too small";
    case FIBRAD_E_TABLE:
        return "that number of samples is not built in";
    case FIBRAD_E_GEOMETRY:
        return "two spheres have the same centre, the centre of one lies inside another, or one reaches beyond an "
               "opening";
    case FIBRAD_E_WORK:
        return "the work memory is too small";
    case FIBRAD_E_STATE:
        return "a call is missing, too early or repeated, or the scene has changed";
    case FIBRAD_E_ISA:
        return "this build or this machine does not have the instruction set";
    case FIBRAD_E_UNSUPPORTED:
        return "this version does not compute that";
    case FIBRAD_E_MEMORY:
        return "out of memory";
    case FIBRAD_E_CANCELLED:
        return "stopped on request";
    case FIBRAD_E_UNSOLVABLE:
        return "no temperatures give the powers that were asked for";
    case FIBRAD_E_BACK:
        return "a side of a triangle that belongs to no wall was seen";
    case FIBRAD_E_SUM:
        return "a row does not add up to 1: a fault of fibrad, please report it";
    case FIBRAD_E_ENDLESS:
        return "the walls form a tube or a corner without end: make the missing side a wall or an opening";
    case FIBRAD_E_FILE:
        return "a file cannot be made or written";
    case FIBRAD_E_UNSETTLED:
        return "the search for radiosities and temperatures does not converge";
    default:
        return "no known status";
    }
}

const char *fibrad_why_text(int why) {
    switch (why) {
    case FIBRAD_WHY_PLACE:
        return "a coordinate is not a number, infinite or too far away";
    case FIBRAD_WHY_RADIUS:
        return "the radius is not above 0 or is out of range";
    case FIBRAD_WHY_BEYOND:
        return "the centre lies beyond a wall";
    case FIBRAD_WHY_WALL:
        return "contradicts the box or another wall, or its position or size is not valid";
    case FIBRAD_WHY_TEMPERATURE:
        return "the temperature is out of range";
    case FIBRAD_WHY_EMISSIVITY:
        return "the emissivity is not within 0 to 1";
    case FIBRAD_WHY_POWER:
        return "the power is out of range";
    case FIBRAD_WHY_BOTH:
        return "has both a temperature and a power; give only one of them";
    case FIBRAD_WHY_NEITHER:
        return "has neither a temperature nor a power";
    case FIBRAD_WHY_REFLECTS:
        return "has emissivity 0 and cannot give off a power";
    case FIBRAD_WHY_STORAGE:
        return "hold or reference is out of range";
    case FIBRAD_WHY_ENDLESS:
        return "is endless and needs a temperature";
    case FIBRAD_WHY_SIDE:
        return "the temperature of a triangle is out of range, or its wall has none";
    case FIBRAD_WHY_SURROUNDINGS:
        return "the temperature of the surroundings is missing or out of range";
    case FIBRAD_WHY_SIGMA:
        return "sigma is out of range";
    case FIBRAD_WHY_TOLERANCE:
        return "the tolerance is out of range";
    case FIBRAD_WHY_MISSING:
        return "an array is missing";
    case FIBRAD_WHY_CONDUCTIVITY:
        return "a conductivity is not above 0";
    case FIBRAD_WHY_CONTACT:
        return "a contact has an end that is neither a sphere nor a wall";
    case FIBRAD_WHY_CONDUCTANCE:
        return "a conductance is negative or out of range";
    case FIBRAD_WHY_TOUCHED:
        return "is in contact, but has no single temperature";
    case FIBRAD_WHY_ALONE:
        return "nothing that it touches radiates or has a temperature";
    case FIBRAD_WHY_CAPACITY:
        return "the heat capacity is not above 0 or is out of range";
    case FIBRAD_WHY_LIGHT:
        return "a number of the light is out of range, or its direction is zero";
    case FIBRAD_WHY_DARK:
        return "no open face lets the light in";
    case FIBRAD_WHY_FOOTPRINT:
        return "lies before the disc of the light";
    default:
        return "the value is not valid";
    }
}

const char *fibrad_version(void) { return FIBRAD_VERSION; }
