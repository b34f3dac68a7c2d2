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
    case FIBRAD_E_ALIGNMENT:
        return "reserved";
    case FIBRAD_E_CAPACITY:
        return "the arrays for a row are too small";
    case FIBRAD_E_TABLE:
        return "that number of samples is not built in";
    case FIBRAD_E_GEOMETRY:
        return "two spheres have the same centre, or the centre of one lies inside another";
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
        return "no temperatures give bodies the powers that were asked for";
    case FIBRAD_E_BACK:
        return "a side of a triangle is seen that belongs to no body";
    default:
        return "no known status";
    }
}

const char *fibrad_version(void) { return FIBRAD_VERSION; }
