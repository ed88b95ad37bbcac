# tests.mk - tests, benches, fuzz targets, and checks of the sources.

.PHONY: test check check-threads coverage compile-tests bench bench-lossy fuzz fuzzers replay golden headers kept layers metrics lint lint-code lint-words format

UNIT_C   := $(wildcard tests/unit/*.c tests/props/*.c tests/kernels/*.c tests/threads/*.c)
GL_C     := $(wildcard tests/gl/*.c)
BENCH_C  := $(wildcard tests/bench/*.c)
FUZZ_C   := $(wildcard tests/fuzz/*.c)
TOOLS_C  := $(wildcard tests/tools/*.c)
UNIT     := $(UNIT_C:%.c=$B/%)
THREADS  := $(filter $B/tests/threads/%,$(UNIT))
GL       := $(GL_C:%.c=$B/%)
BENCH    := $(BENCH_C:%.c=$B/%)
# Benches that draw are linked as the tests of GL are.
GL_BENCH := $(addprefix $B/tests/bench/,bench_viewer bench_objects bench_seeing)
FUZZ     := $(FUZZ_C:%.c=$B/%)
TOOLS    := $(TOOLS_C:%.c=$B/%) $(SAMPLES)
CMOCKA    = $(call once,CMOCKA,pkg-config --libs cmocka)
FUZZ_S   ?= 20

# ---------------------------------------------------------------- compiling

# Tests themselves are many and short: compiled fast, and linked by the faster linker where it is, without
# symbols for debuggers (config=debug has them).
$(patsubst %.c,$B/obj/%.o,$(UNIT_C) $(GL_C) $(FUZZ_C)): own_mode = $(if $(filter release,$(config)),-O1 -g0)
$B/obj/tests/%.o: own_include = -Isrc -Itests -Iviewer
$B/obj/tests/tools/decode.o $B/obj/tests/unit/test_piz.o: own_flags = $(EXR)
TEST_LD := $(if $(shell command -v ld.gold),-fuse-ld=gold) $(if $(filter release,$(config)),-Wl$(comma)-S)

# ---------------------------------------------------------------- linking

# Tests of threads leave a map of the linker, which says what of the library they take (make/sanitizers.mk).
$(UNIT): $B/tests/%: $B/obj/tests/%.o
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..) $(if $(filter $@,$(THREADS)),-Wl$(comma)-Map=$@.map) $(FIXED) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LDFLAGS) $(LIBS) $(CMOCKA)
$(filter-out $(THREADS),$(UNIT)): $B/librelume.a
# What the tool measures stands outside of the library.
$B/tests/unit/test_octree: $B/obj/src/cli/measure/octree.o
$B/tests/unit/test_reflected_places: $(addprefix $B/obj/src/cli/measure/,bezier.o triangle.o)
$(TOOLS_C:%.c=$B/%): $B/%: $B/obj/%.o $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..:$$ORIGIN/..) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS)
$(GL) $(GL_BENCH): $B/tests/%: $B/obj/tests/%.o $(filter-out %/main.o,$(VIEWER_O)) $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CXX) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(GL_LIBS) $(CMOCKA)
$(filter-out $(GL_BENCH),$(BENCH)) $(FUZZ): $B/tests/%: $B/obj/tests/%.o $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(LINK) $(MODE) $(TEST_LD) $(FUZZ_ENGINE) -pthread $(call run_path,/../..) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LDFLAGS) $(LIBS) $(if $(@:%/fuzz_command=),,$(CLI_LIBS))
# The tool without its main
$B/tests/fuzz/fuzz_command: $(filter-out %/main.o %/start.o,$(CLI_O))
# The viewer without its window
$B/tests/fuzz/fuzz_script: $(filter $B/obj/viewer/app/% $B/obj/viewer/common/% $B/obj/src/cli/program/%,$(VIEWER_O))
# Programs open the modules when they run, but for the tests of threads.
$(filter-out $(THREADS),$(UNIT)) $(GL) $(BENCH) $(FUZZ) $(TOOLS): | $(MODULE) $(MESHES) $(HELPER)

# The tool with a basis and a model of one file each, for tests/cli/test_growing.sh
GROWN   := $B/tests/growing/relume
GROWN_O := $(addprefix $B/obj/tests/growing/,basis_linear.o model_mean.o bases.o models.o)
$B/obj/tests/growing/bases.c: src/format/coder/coder.c
	@mkdir -p $(@D)
	$(Q)sed 's/&relume_basis_table,/\&relume_basis_linear, &/; /^const struct relume_basis .const relume_bases/i extern const struct relume_basis relume_basis_linear;' $< > $@
$B/obj/tests/growing/models.c: src/material/model/model.c
	@mkdir -p $(@D)
	$(Q)sed 's/&model_lit,/\&model_mean, &/; /^const struct relume_btf_model .const relume_btf_models/i extern const struct relume_btf_model model_mean;' $< > $@
$(addprefix $B/obj/tests/growing/,bases.o models.o): %.o: %.c | $(DEPS)
	$(Q)$(CC) $(C11) -Iinclude -Isrc -c -o $@ $<
$(GROWN): $(GROWN_O) $(CLI_O) $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..) -o $@ $^ $(LDFLAGS) $(LIBS) $(CLI_LIBS)

# Lets calls to the system fail (tests/tools/faults.sh)
FAULTS := $B/tests/tools/faults.so
$(FAULTS): tests/tools/preload/faults.c | $(DEPS)
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) -std=c11 -O1 $(filter-out -Wpedantic,$(WARNINGS)) -shared -fPIC -o $@ $< -ldl

# ---------------------------------------------------------------- testing

# `make test` is everything; `make check` is the part that one config runs.
test:
	@tests/run.sh $(MAKE)
# Sanitizers run few scripts (tests/check.sh), none of which needs these.
check: all $(UNIT) $(GL) $(TOOLS) $(FAULTS) $B/tests/core.so $(if $(filter asan tsan,$(config)),,$(FUZZ) $(GROWN))
	@tests/check.sh $B
check-threads: $(THREADS)
	@ONLY_BINARIES=1 tests/check.sh $B
# Lines of src and viewer that make check runs; what failed does not stop the count.
coverage:
	@find build/coverage -name '*.gcda' -delete 2>/dev/null; TEST_LIMIT_S=1200 $(MAKE) -s config=coverage check; tests/coverage.sh build/coverage
# Does every test still compile? A minute where check takes five.
compile-tests: $(patsubst %.c,$B/obj/%.o,$(UNIT_C) $(GL_C) $(TOOLS_C) $(FUZZ_C) $(BENCH_C))

bench: all $(BENCH)
	@tests/bench/run.sh $B

# Bytes, quality and seconds of every way to code planes with loss: make bench-lossy CAPTURES='a.lp b.lp'
bench-lossy: $B/tests/bench/bench_lossy
	@$< $(CAPTURES)

fuzz: $(FUZZ)
	@for f in $(FUZZ); do $$f $(FUZZ_S) || exit 1; done
fuzzers: $(FUZZ)
# The seeds, and the inputs that once failed
replay: $(FUZZ)
	@for f in $(FUZZ); do $$f seeds $$(find tests/fuzz/corpus/$${f##*/} -type f 2>/dev/null) || exit 1; done

# The frames that tests/cli/test_golden.sh compares with, to be looked at before they are committed
golden: cli viewer
	@RELUME=$(CURDIR)/$B/relume VIEWER=$(CURDIR)/$B/relume-view TOP=$(CURDIR) BUILD=$(CURDIR)/$B STORE=1 tests/cli/test_golden.sh

# Small files of each kind that this version writes, for every later one to read (tests/cli/test_kept.sh): only
# missing files are added. Each version of the format has a folder.
kept: cli $B/samples/sphere
	@scripts/kept.sh add $B tests/kept/$(shell sed -n 's/^.define RELUME_VERSION "\([0-9]*[.][0-9]*\)[.].*/\1/p' include/relume/base.h)

# ---------------------------------------------------------------- the sources

headers: $(HEADERS:include/relume/%.h=$B/headers/%.ok) $(if $(shell command -v python3),$B/headers/python.ok)
$B/headers/%.ok: include/relume/%.h $(HEADERS) | $(DEPS)
	@mkdir -p $(@D)
	$(CC) -std=c11 $(WARNINGS) -Werror -Iinclude -fsyntax-only -x c $<
	$(CXX) -std=c++17 -Wall -Wextra -Wpedantic -Werror -Iinclude -fsyntax-only -x c++ $<
	@touch $@
# What the Python module knows of the headers (python/relume/_abi.py) is what they say.
$B/headers/python.ok: python/relume/_abi.py $(HEADERS) | $(DEPS)
	@mkdir -p $(@D)
	python3 $< > $(@D)/python.c
	$(CC) -std=c11 -Wall -Werror -Iinclude -o $(@D)/python $(@D)/python.c
	python3 $< layout > $(@D)/python.txt
	$(@D)/python | diff $(@D)/python.txt -
	@touch $@

layers:
	@scripts/layers.sh

# The sources in numbers: docs/measurements/house.md
metrics: all
	@scripts/metrics.sh $B >$B/house.md && mv $B/house.md docs/measurements/house.md
	@sed -n 's/^| \([^|]*\) | \([^|]*\) |$$/\2  \1/p' docs/measurements/house.md

# What cppcheck finds is mended, or said to be none in scripts/lint.supp. Short names of vectors are
# for programs that use the library: with them every source would be looked at twice.
LINTED := src viewer
lint: lint-code lint-words
lint-code:
	@mkdir -p $B/lint
	@cppcheck -q -j2 --std=c11 --enable=warning,portability --suppressions-list=scripts/lint.supp --error-exitcode=1 \
	    --cppcheck-build-dir=$B/lint -URELUME_VEC3_SHORT -Uvec3_of \
	    -Iinclude -Isrc -Iviewer $(LINTED)
# Findings in the language of pages, comments, help and messages never grow; when some go, save the new totals:
# scripts/words.py --summary . > scripts/words.ceiling
lint-words:
	@if command -v python3 >/dev/null; then python3 scripts/words.py --ceiling scripts/words.ceiling .; \
	    else echo "skipped: lint-words: no python3"; fi

format:
	clang-format -i $(LIB_C) $(MODULE_CXX) src/core/kernel/lsq_eigen.cpp $(MESHES_C) $(STITCH_CXX) $(HELPER_C) $(wildcard src/cli/mpi/*.c) $(CLI_C) $(VIEWER_C) $(VIEWER_CXX) $(HEADERS) $(UNIT_C) $(GL_C) \
	    $(BENCH_C) $(FUZZ_C) $(TOOLS_C) $(wildcard src/*/*/*.h src/cli/*.h viewer/*/*.h tests/*.h tests/fuzz/*.h samples/*.c)
