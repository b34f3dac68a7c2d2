/* fibrad_plugin.cpp - makes the fix known to a LAMMPS that has the PLUGIN package, through `plugin load`.
 * SPDX-License-Identifier: MIT. LAMMPS is GPL-2: so are binaries made with its headers. */
#include "fix_fibrad.h"

#include "lammpsplugin.h"
#include "version.h"

using namespace LAMMPS_NS;

extern "C" void lammpsplugin_init(void *lmp, void *handle, void *regfunc) {
    lammpsplugin_t plugin = {};
    plugin.version = LAMMPS_VERSION;
    plugin.style = "fix";
    plugin.name = "fibrad";
    plugin.info = "thermal radiation between particles, fibrad " FIBRAD_VERSION;
    plugin.author = "fibrad";
    plugin.creator.v2 = &FixFibrad::create;
    plugin.handle = handle;
    ((lammpsplugin_regfunc)regfunc)(&plugin, lmp);
}
