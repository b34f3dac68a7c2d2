# liggghts.mk - the driver of LIGGGHTS; included by host/couple/couple.mk. SPDX-License-Identifier: MIT

LIGGGHTS_INCLUDE = /usr/include/liggghts
LIGGGHTS_OBJECTS = $(BUILD)/couple/fibrad_liggghts.o $(BUILD)/couple/liggghts_options.o
LIGGGHTS_FLAGS   = -std=c++14 $(COUPLE_CXX) -isystem $(LIGGGHTS_INCLUDE)

COUPLE_SCRIPTS  += tests/couple/check_liggghts.sh
COUPLE_PRODUCTS += $(BUILD)/couple/fibrad_liggghts

$(LIGGGHTS_OBJECTS): $(BUILD)/couple/%.o: host/couple/liggghts/%.cpp | need-mpi need-liggghts
	@mkdir -p $(@D)
	$(MPICXX) $(LIGGGHTS_FLAGS) -c $< -o $@

$(BUILD)/couple/fibrad_liggghts: $(LIGGGHTS_OBJECTS) $(COUPLE_MESH_LIB) $(COUPLE_LIBS)
	$(MPICXX) $(LDFLAGS) -fopenmp $(LIGGGHTS_OBJECTS) $(COUPLE_MESH_LIB) $(COUPLE_LIBS) $(ZLIB_LIBS) -lliggghts -o $@

$(LIGGGHTS_OBJECTS): Makefile host/couple/liggghts/liggghts.mk

-include $(LIGGGHTS_OBJECTS:.o=.d)

need-liggghts: | $(COUPLE_DEPS)
	@test -e $(LIGGGHTS_INCLUDE)/library.h || { echo "The driver of LIGGGHTS needs its library: run 'make deps-couple'" \
	    "(Debian: libliggghts-dev)." >&2; exit 1; }

.PHONY: demo-liggghts need-liggghts

## demo-liggghts: a bed on a hot floor in LIGGGHTS on 2 ranks, by conduction alone and with radiation beside it
demo-liggghts: deps deps-couple
	@$(MAKE) -s --no-print-directory $(BUILD)/couple/fibrad_liggghts
	BUILD=$(BUILD) host/couple/liggghts/demo_liggghts.sh
