# liggghts.mk - the driver of LIGGGHTS; included by host/couple/couple.mk. SPDX-License-Identifier: MIT

LIGGGHTS_HERE    = $(wildcard /usr/include/liggghts/library.h)
LIGGGHTS_OBJECTS = $(BUILD)/couple/fibrad_liggghts.o $(BUILD)/couple/liggghts_options.o
LIGGGHTS_FLAGS   = -std=c++14 $(COUPLE_CXX) -isystem /usr/include/liggghts

COUPLE_SCRIPTS  += tests/couple/check_liggghts.sh
COUPLE_PRODUCTS += $(if $(LIGGGHTS_HERE),$(BUILD)/couple/fibrad_liggghts)

$(LIGGGHTS_OBJECTS): $(BUILD)/couple/%.o: host/liggghts/%.cpp | need-mpi
	@mkdir -p $(@D)
	$(MPICXX) $(LIGGGHTS_FLAGS) -c $< -o $@

$(BUILD)/couple/fibrad_liggghts: $(LIGGGHTS_OBJECTS) $(COUPLE_MESH_LIB) $(COUPLE_LIBS)
	$(MPICXX) $(LDFLAGS) -fopenmp $(LIGGGHTS_OBJECTS) $(COUPLE_MESH_LIB) $(COUPLE_LIBS) $(ZLIB_LIBS) -lliggghts -o $@

$(LIGGGHTS_OBJECTS): Makefile host/liggghts/liggghts.mk

-include $(LIGGGHTS_OBJECTS:.o=.d)

## demo-liggghts: a bed on a hot floor in LIGGGHTS on 2 ranks, by conduction alone and with radiation beside it
demo-liggghts: deps deps-couple
	@$(MAKE) -s --no-print-directory $(BUILD)/couple/fibrad_liggghts
	BUILD=$(BUILD) host/liggghts/demo_liggghts.sh
