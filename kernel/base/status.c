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
        return "the memory block does not begin on a 64-byte boundary";
    case FIBRAD_E_CAPACITY:
        return "an output array or the work memory is too small";
    case FIBRAD_E_TABLE:
        return "that number of samples is not built in";
    case FIBRAD_E_GEOMETRY:
        return "two spheres have the same centre, or the centre of one lies inside another";
    default:
        return "no known status";
    }
}

const char *fibrad_version(void) { return FIBRAD_VERSION; }
