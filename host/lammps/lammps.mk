# lammps.mk - fix fibrad of LAMMPS; included by host/couple/couple.mk. SPDX-License-Identifier: MIT
#
# For Debian's LAMMPS as it is installed; for a newer one with the PLUGIN package: make LAMMPS_SOURCE=TREE couple.

LAMMPS_SOURCE =
LAMMPS_SIZES  = -DLAMMPS_SMALLBIG

LAMMPS_FLAGS  = $(COUPLE_CXX) -fPIC $(LAMMPS_SIZES)
LAMMPS_LINK   = -shared -fopenmp -Wl,--exclude-libs,ALL
LAMMPS_HERE   = $(wildcard /usr/include/lammps/fix.h)
FIX           = host/lammps/fix_fibrad.cpp

COUPLE_PRODUCTS += $(if $(LAMMPS_HERE),$(BUILD)/couple/fix_fibrad.so $(BUILD)/couple/fibrad.lmp) \
    $(if $(LAMMPS_SOURCE),$(BUILD)/couple/fibrad_plugin.so)

# C++14: the headers of Debian's LAMMPS want no more
$(BUILD)/couple/fix_fibrad.so: $(FIX) $(COUPLE_MESH_LIB) $(COUPLE_LIBS)
	$(MPICXX) -std=c++14 $(LAMMPS_FLAGS) -isystem host/lammps/debian -isystem /usr/include/lammps $(LAMMPS_LINK) \
	    $(FIX) $(COUPLE_MESH_LIB) $(COUPLE_LIBS) $(ZLIB_LIBS) -llammps -o $@

$(BUILD)/couple/fibrad.lmp: host/lammps/fibrad.lmp.in $(BUILD)/couple/fix_fibrad.so
	sed 's|@FIX@|$(abspath $(@D))/fix_fibrad.so|' $< > $@

$(BUILD)/couple/fibrad_plugin.so: $(FIX) host/lammps/fibrad_plugin.cpp $(COUPLE_MESH_LIB) $(COUPLE_LIBS)
	$(MPICXX) -std=c++17 $(LAMMPS_FLAGS) -isystem $(LAMMPS_SOURCE)/src $(LAMMPS_LINK) \
	    $(FIX) host/lammps/fibrad_plugin.cpp $(COUPLE_MESH_LIB) $(COUPLE_LIBS) $(ZLIB_LIBS) -o $@

$(BUILD)/couple/fix_fibrad.so $(BUILD)/couple/fibrad_plugin.so: Makefile host/lammps/lammps.mk

-include $(BUILD)/couple/fix_fibrad.d $(BUILD)/couple/fibrad_plugin.d

COUPLE_SCRIPTS += tests/couple/check_lammps.sh

# programs that check_lammps.sh compares with
LAMMPS_CHECKS = $(BUILD)/tests/couple/serial_bed $(BUILD)/tests/couple/sorted_rows

$(LAMMPS_CHECKS): $(BUILD)/%: %.c $(BUILD)/libfibrad.a
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(COMMON) -Ihost/couple $(LDFLAGS) $< $(BUILD)/libfibrad.a -lm -o $@

.PHONY: demo-lammps

## demo-lammps: pebbles poured onto a hot floor in LAMMPS on 2 ranks: energy balance, T against time, picture, ParaView
demo-lammps: deps deps-couple
	@$(MAKE) -s --no-print-directory couple
	@BUILD=$(BUILD) MPIRUN=$(MPIRUN) host/lammps/demo.sh
