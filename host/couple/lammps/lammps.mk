# lammps.mk - fix fibrad of LAMMPS; included by host/couple/couple.mk. SPDX-License-Identifier: MIT
#
# For Debian's LAMMPS as it is installed; for a newer one with the PLUGIN package: make LAMMPS_SOURCE=TREE lammps.

LAMMPS_SOURCE =
LAMMPS_INCLUDE = /usr/include/lammps
LAMMPS_SIZES  = -DLAMMPS_SMALLBIG

LAMMPS_FLAGS  = $(COUPLE_CXX) -fPIC $(LAMMPS_SIZES)
LAMMPS_LINK   = -shared -fopenmp -Wl,--exclude-libs,ALL
FIX           = host/couple/lammps/fix_fibrad.cpp

LAMMPS_PRODUCTS  = $(if $(LAMMPS_SOURCE),$(BUILD)/couple/fibrad_plugin.so,$(BUILD)/couple/fix_fibrad.so $(BUILD)/couple/fibrad.lmp)
COUPLE_PRODUCTS += $(LAMMPS_PRODUCTS)

## lammps: fix fibrad of LAMMPS alone, or with LAMMPS_SOURCE=TREE its plugin for that LAMMPS (on a fresh machine: make deps-couple lammps)
lammps: $(LAMMPS_PRODUCTS)

# C++14: the headers of Debian's LAMMPS want no more
$(BUILD)/couple/fix_fibrad.so: $(FIX) $(COUPLE_MESH_LIB) $(COUPLE_LIBS) | need-lammps
	$(MPICXX) -std=c++14 $(LAMMPS_FLAGS) -isystem host/couple/lammps/debian -isystem $(LAMMPS_INCLUDE) $(LAMMPS_LINK) \
	    $(FIX) $(COUPLE_MESH_LIB) $(COUPLE_LIBS) $(ZLIB_LIBS) -llammps -o $@

$(BUILD)/couple/fibrad.lmp: host/couple/lammps/fibrad.lmp.in $(BUILD)/couple/fix_fibrad.so
	sed 's|@FIX@|$(abspath $(@D))/fix_fibrad.so|' $< > $@

$(BUILD)/couple/fibrad_plugin.so: $(FIX) host/couple/lammps/fibrad_plugin.cpp $(BUILD)/couple/lammps_source $(COUPLE_MESH_LIB) $(COUPLE_LIBS)
	$(MPICXX) -std=c++17 $(LAMMPS_FLAGS) -isystem $(LAMMPS_SOURCE)/src $(LAMMPS_LINK) \
	    $(FIX) host/couple/lammps/fibrad_plugin.cpp $(COUPLE_MESH_LIB) $(COUPLE_LIBS) $(ZLIB_LIBS) -o $@

# the tree of the last plugin: another tree, another plugin
$(BUILD)/couple/lammps_source: always
	@mkdir -p $(@D)
	@echo $(LAMMPS_SOURCE) | cmp -s - $@ || echo $(LAMMPS_SOURCE) > $@

always:

$(BUILD)/couple/fix_fibrad.so $(BUILD)/couple/fibrad_plugin.so: Makefile host/couple/lammps/lammps.mk

-include $(BUILD)/couple/fix_fibrad.d $(BUILD)/couple/fibrad_plugin.d

COUPLE_SCRIPTS += tests/couple/check_lammps.sh tests/couple/check_pages.sh

# programs that check_lammps.sh compares with
LAMMPS_CHECKS = $(BUILD)/tests/couple/serial_bed $(BUILD)/tests/couple/sorted_rows

$(LAMMPS_CHECKS): $(BUILD)/%: %.c $(BUILD)/libfibrad.a
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(COMMON) -Ihost/couple $(LDFLAGS) $< $(BUILD)/libfibrad.a -lm -o $@

need-lammps: | $(COUPLE_DEPS)
	@test -e $(LAMMPS_INCLUDE)/fix.h || { echo "fix fibrad needs LAMMPS: run 'make deps-couple' (Debian: liblammps-dev)," \
	    "or name the source of yours: make LAMMPS_SOURCE=TREE lammps." >&2; exit 1; }

.PHONY: always lammps demo-lammps need-lammps

## demo-lammps: pebbles poured onto a hot floor in LAMMPS on 2 ranks: energy balance, T against time, picture, ParaView
demo-lammps: deps deps-couple
	@$(MAKE) -s --no-print-directory lammps
	@BUILD=$(BUILD) MPIRUN=$(MPIRUN) host/couple/lammps/demo.sh
