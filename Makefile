# relume - the whole build. `make` builds, `make demo` and `make test` do all set-up by themselves.
#
#   config=release (default, into build/) | debug | asan | tsan | fuzzer | msan   (into build/CONFIG/)
#   FFT=fftw (default) | kiss   (a library without parts under the GPL; after make clean)
#   LIBDIR=lib (default)        where `make install` puts libraries, below PREFIX
#   RUN_PATH=no                 for packages: programs look for libraries where the system does, no more

config ?= release
FFT ?= fftw
PREFIX ?= /usr/local
LIBDIR ?= lib
FUZZ_S ?= 20
# make V=1 shows whole commands
Q := $(if $(V),,@)
say = $(if $(V),,@echo '  $1 $@')

B := $(if $(filter release,$(config)),build,build/$(config))
# The first number of the version names the shared library: librelume.so.0
MAJOR := $(shell sed -n 's/^.define RELUME_VERSION "\([0-9]*\)\..*/\1/p' include/relume/base.h)

CC       ?= gcc
CXX      ?= g++
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wvla -Wwrite-strings
COMMON   := -g -fPIC -fvisibility=hidden -MMD -MP -pthread -ffp-contract=off \
            -fno-math-errno -fno-trapping-math -ffile-prefix-map=$(CURDIR)=. $(WARNINGS)
# What stops hostile files should a reader of ours or of a library be wrong. Checked by test_build.sh.
release  := -O3 -DNDEBUG -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3 -fstack-protector-strong \
            -fstack-clash-protection
debug    := -O0
asan     := -O1 -g1 -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer
tsan     := -O1 -g1 -fsanitize=thread
# clang's libFuzzer with its sanitizers: make config=fuzzer fuzzers
fuzzer   := -O1 -g1 -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow \
            -fno-sanitize-recover=all -DRELUME_LIBFUZZER
# values used before they are set, in targets of libFuzzer: scripts/msan.sh, make config=msan fuzzers
msan     := -O1 -g1 -fsanitize=fuzzer-no-link,memory -fsanitize-memory-track-origins -fno-omit-frame-pointer \
            -fno-sanitize-recover=all -DRELUME_LIBFUZZER -DNO_MODULES
FUZZ_ENGINE ?= -fsanitize=fuzzer
CLANG    := $(filter fuzzer msan,$(config))
ifneq ($(CLANG),)
CC       := clang
CXX      := clang++
endif
# clang's checks of C++ (function, vptr) want its C++ runtime in the program
LINK     := $(if $(CLANG),$(CXX),$(CC))
MODE     := $($(config))
ifeq ($(MODE),)
$(error config=$(config): expected release, debug, asan, tsan, fuzzer or msan)
endif
# Threads may have stacks of 128 kB (docs/architecture.md); those of tests are large. Checked by test_build.sh.
FRAMES    = $(if $(filter release,$(config)),$(if $(filter $B/obj/tests/%,$@),,-Werror=frame-larger-than=98304))
C11      := -std=c11 -D_GNU_SOURCE $(COMMON) $(MODE) -Wstrict-prototypes -Wmissing-prototypes
CXX17    := -std=c++17 $(COMMON) $(MODE)

# Asked of pkg-config once, after the packages are there.
once     = $(eval $1 := $$(shell $2))$($1)
EXR      = $(call once,EXR,pkg-config --cflags OpenEXR)
OIIO     = $(call once,OIIO,pkg-config --cflags OpenImageIO)
IMGUI    = $(call once,IMGUI,pkg-config --cflags imgui)
GLFW     = $(call once,GLFW,pkg-config --cflags glfw3)
FFT_PC   := $(if $(filter kiss,$(FFT)),kissfft-float,fftw3f)
PKG_LIBS = $(call once,PKG_LIBS,pkg-config --libs OpenEXR jansson libjpeg libpng lcms2 aom dav1d zlib $(FFT_PC))
ifeq ($(config),msan)
# The C libraries built for it; of the others tests/tools/preload/msan.c tells.
MSAN_TOLD := nftw rtcNewDevice rtcReleaseDevice rtcCommitGeometry rtcCommitScene rtcReleaseScene rtcIntersect1 rtcOccluded16 \
             $(addprefix dav1d_,default_settings open close data_wrap send_data get_picture picture_unref) \
             $(addprefix aom_,codec_enc_config_default codec_enc_init_ver codec_enc_config_set img_alloc codec_encode \
             codec_get_cx_data codec_destroy)
MSAN_TOLD_O := $B/obj/tests/tools/preload/msan.o
PKG_LIBS  = $(MSAN_TOLD:%=-Wl,--wrap=%) $(MSAN_TOLD_O) -L$B/lib -l:libOpenEXRCore.a -ljansson -ljpeg -lpng -llcms2 -lz \
            -lImath-3_1 -laom -ldav1d -lfftw3f
endif
OIIO_LIBS = $(call once,OIIO_LIBS,pkg-config --libs OpenImageIO)
EIGEN    = $(call once,EIGEN,pkg-config --cflags eigen3)
CAIRO    = $(call once,CAIRO,pkg-config --cflags cairo)
LIBS     = -Wl,--as-needed $(PKG_LIBS) -lembree3 -lstdc++ -lm -ldl
CLI_LIBS = $(call once,CLI_LIBS,pkg-config --libs cairo)
GL_LIBS  = $(call once,GL_LIBS,pkg-config --libs glfw3 osmesa egl imgui)
CMOCKA   = $(call once,CMOCKA,pkg-config --libs cmocka)

# Every folder of src is a wing of the library, and theirs are rooms, but for the programs.
LIB_C    := $(filter-out src/cli/% src/shape/mesh/mesh_assimp.c,$(wildcard src/*/*/*.c))
LIB_C    := $(filter-out $(if $(filter kiss,$(FFT)),%/fft.c,%/fft_kiss.c),$(LIB_C))
# The module that is loaded when the first image needs it (src/image/image/picture.h)
MODULE_CXX := src/image/image/oiio.cpp
# The module that is loaded when the first model needs it (src/shape/mesh/mesh_other.h)
MESHES_C := src/shape/mesh/mesh_assimp.c
# Built where OpenCV's stitching is (make deps-stitch); opened to stitch photographs
OPENCV   := $(firstword $(wildcard $(addsuffix /opencv4,/usr/include /usr/local/include)))
STITCH_CXX := $(if $(wildcard $(OPENCV)/opencv2/stitching/detail/matchers.hpp),src/capture/multiview/stitch.cpp)
# The program in which foreign files are read (src/core/base/helper.h); it lies beside the modules
HELPER_C := $(wildcard src/cli/helper/*.c)
# The tool for all processes of an MPI launcher, built where one is (make deps-mpi); some packages
# bring mpicc without the header
MPI_C    := $(if $(shell echo 'int mpi;' | mpicc -include mpi.h -fsyntax-only -x c - 2>/dev/null && echo there),$(wildcard src/cli/mpi/*.c))
# src/cli/program is what the tool and the viewer share.
CLI_C    := $(filter-out src/cli/helper/% src/cli/mpi/%,$(wildcard src/cli/*.c src/cli/*/*.c))
VIEWER_C := $(wildcard src/cli/program/*.c viewer/*/*.c)
VIEWER_CXX := $(wildcard viewer/*/*.cpp)
# What `relume publish` puts into every site; the core is compiled by make web
WEB_OBJECT := $(wildcard web/object*.js)
# ... what pages load when a file or a lamp needs it (web/more.js)
WEB_MORE := web/near.js web/pins.js $(wildcard web/moving*.js)
WEB_JS   := $(filter-out $(WEB_OBJECT) $(WEB_MORE),$(wildcard web/*.js))
# ... of which pages of objects have these, and nothing else
WEB_SHARED := $(addprefix web/,ball.js compare.js controls.js gl.js lights.js load.js marks.js noteindex.js notepanel.js notes.js overlay.js pins.js pointer.js profilegraph.js shaders.js stage.js \
              state.js wasm.js)
WEB_CORE := $(wildcard web/core/relume-core.wasm)
WEB_OPEN := $(wildcard web/open/relume-open.wasm web/open/licences.txt)
WEB_CSS  := $(wildcard web/*.css)
SHADERS  := $(wildcard viewer/shaders/*.glsl viewer/shaders/*/*.glsl)
HEADERS  := $(wildcard include/relume/*.h include/relume/*/*.h)
UNIT_C   := $(wildcard tests/unit/*.c tests/props/*.c tests/kernels/*.c tests/threads/*.c)
GL_C     := $(wildcard tests/gl/*.c)
BENCH_C  := $(wildcard tests/bench/*.c)
FUZZ_C   := $(wildcard tests/fuzz/*.c)
TOOLS_C  := $(wildcard tests/tools/*.c)
# minimal.c, memory.c, batch.c and viewer.c are built against the installed library instead (tests/cli/test_install.sh)
SAMPLES_C := samples/sphere.c samples/figures.c samples/mirrorball.c

# Instruction sets beyond the baseline; what is written for another processor compiles to nothing.
# Where no compiler is yet (make deps gets one, later in this run), the machine says what it is.
AVX2     := $(if $(filter x86_64%,$(shell $(CC) -dumpmachine 2>/dev/null || uname -m)),-mavx2 -mfma -mf16c)
AVX512   := $(if $(AVX2),$(AVX2) -mavx512f -mavx512bw -mavx512dq -mavx512vl)
LIB_O    := $(LIB_C:%.c=$B/obj/%.o) $B/obj/web/assets.o $(addprefix $B/obj/src/core/kernel/lsq_eigen,.o $(if $(AVX2),_avx2.o _avx512.o))
MODULE   := $B/librelume-oiio.so.$(MAJOR)
MESHES   := $B/librelume-assimp.so.$(MAJOR)
STITCH   := $(if $(STITCH_CXX),$B/librelume-stitch.so.$(MAJOR))
HELPER   := $B/relume-helper
MPI      := $(if $(MPI_C),$B/relume-mpi)
CLI_O    := $(CLI_C:%.c=$B/obj/%.o)
VIEWER_O := $(VIEWER_C:%.c=$B/obj/%.o) $(VIEWER_CXX:%.cpp=$B/obj/%.o) $B/obj/viewer/shaders.o
UNIT     := $(UNIT_C:%.c=$B/%)
THREADS  := $(filter $B/tests/threads/%,$(UNIT))
GL       := $(GL_C:%.c=$B/%)
BENCH    := $(BENCH_C:%.c=$B/%)
FUZZ     := $(FUZZ_C:%.c=$B/%)
TOOLS    := $(TOOLS_C:%.c=$B/%) $(SAMPLES_C:%.c=$B/%)
VIEWER   := $B/relume-view

.PHONY: all lib cli viewer samples deps deps-web web deps-stitch deps-mpi deps-python demo demo-web tour tutorials figures golden test check check-threads compile-tests bench fuzz fuzzers replay headers layers metrics lint format install \
        clean
.DELETE_ON_ERROR:
all: lib cli viewer $B/layers.ok
lib: $B/librelume.a $B/librelume.so $(MODULE) $(MESHES) $(HELPER) $(STITCH)
cli: $B/relume $(MPI)
viewer: $(VIEWER)
samples: $(SAMPLES_C:%.c=$B/%)

# ---------------------------------------------------------------- set-up

DEPS := build/.deps
deps: $(DEPS)
$(DEPS): scripts/deps.sh
	@mkdir -p $(@D)
	@scripts/deps.sh
	@touch $@
deps-web:
	@scripts/deps.sh web
	@npm install --silent --no-save --prefix build/web gltf-validator@2.0.0-dev.3.10 three@0.187.0 axe-core@4.14.1
	@scripts/iiif-viewers.sh build/web/iiif
deps-stitch:
	@scripts/deps.sh stitch
deps-mpi:
	@scripts/deps.sh mpi
deps-docs:
	@scripts/deps.sh docs
deps-python:
	@scripts/deps.sh python

# ---------------------------------------------------------------- the page's core

# What pages compute by the library itself (web/core/core.c), and what opens files that are dropped onto them
# (web/open/open.c), compiled for browsers. The results are kept in the tree: only who changes these sources needs
# emscripten (Debian's 3.1.6; another one gives other bytes).
CORE_C := $(wildcard web/core/*.c src/format/coder/interpolant_*.c) $(addprefix src/,$(addprefix format/coder/,coder.c basis_table.c \
          basis_ptm.c basis_hsh.c basis_sh.c basis_dct.c basis_dct_resampled.c harmonics.c disc.c zone.c mesh.c) \
          core/math/hull.c core/math/sh.c core/math/hsh.c $(addprefix relight/light/,environment.c directions.c cells.c triangles.c))
web:
	scripts/web-core.sh web/core/relume-core.wasm $(CORE_C)
	scripts/web-open.sh web/open/relume-open.wasm
# The same natively, for tests.
$B/tests/core.so: $(CORE_C) | $(DEPS)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(filter-out -MMD -MP,$(C11)) -Iinclude -Isrc -shared -Wl,-z,defs -Wl,-Bsymbolic -o $@ $(CORE_C) -lm

# ---------------------------------------------------------------- compiling

$B/obj/src/image/image/exr.o: own_flags = $(EXR)
$B/obj/src/image/image/oiio.o: own_flags = $(OIIO)
$B/obj/src/capture/multiview/stitch.o: own_flags = -isystem $(OPENCV)
$B/obj/src/core/base/module.o: own_flags = -DRELUME_MAJOR=$(MAJOR)
$B/obj/src/%_avx2.o: own_flags = $(AVX2)
$B/obj/src/%_avx512.o: own_flags = $(AVX512)
# One source, three objects: see its head. Without optimising Eigen is a hundred times slower, and its
# debug symbols are ten times the rest of the library. gcc 12 warns of its own headers (PR 105593). Looked at by
# ASan alone, of the one that most machines run: the others are the release's under sanitizers, since each takes
# half a minute to compile, for findings in Eigen.
eigen_mode = $(if $(filter asan,$(config)),-O1 -fno-sanitize=undefined,-O2)
eigen_flags = -isystem $(patsubst -I%,%,$(EIGEN)) $(eigen_mode) -g0 -DEIGEN_STACK_ALLOCATION_LIMIT=24576 -DEigen=eigen_$1 -DLSQ_KERNELS=lsq_kernels_$1
EIGEN_SHARED := $(addprefix obj/src/core/kernel/lsq_eigen,$(if $(filter asan tsan,$(config)),.o $(if $(AVX2),_avx512.o)) $(if $(AVX2),$(if $(filter tsan,$(config)),_avx2.o)))
$B/obj/src/core/kernel/lsq_eigen.o: own_flags = $(call eigen_flags,plain)
$B/obj/src/core/kernel/lsq_eigen_avx2.o: own_flags = $(call eigen_flags,avx2) $(AVX2)
$B/obj/src/core/kernel/lsq_eigen_avx512.o: own_flags = $(call eigen_flags,avx512) $(AVX512) -Wno-uninitialized -Wno-maybe-uninitialized
$B/obj/src/%.o:               own_include = -Isrc
$B/obj/src/cli/plot.o: own_flags = $(CAIRO)
$(MPI_C:%.c=$B/obj/%.o):      own_flags = $(patsubst -I%,-isystem %,$(shell mpicc --showme:compile))
$B/obj/viewer/%.o:            own_include = -Iviewer -Isrc
$B/obj/viewer/window/context_glfw.o: own_flags = $(GLFW)
$(VIEWER_CXX:%.cpp=$B/obj/%.o): own_flags = $(IMGUI) -Wno-shadow
$B/obj/tests/tools/decode.o $B/obj/tests/unit/test_piz.o: own_flags = $(EXR)
$B/obj/tests/%.o:             own_include = -Isrc -Itests -Iviewer
# Tests themselves are many and short: compiled fast, and linked by the faster linker where it is, without
# symbols for debuggers (config=debug has them). So are the programs for sanitizers: what takes time in them is the
# library, but where a test makes its photographs itself, or the viewer looks for triangles.
$(patsubst %.c,$B/obj/%.o,$(UNIT_C) $(GL_C) $(FUZZ_C)): own_mode = $(if $(filter release,$(config)),-O1 -g0)
ifneq ($(filter asan tsan,$(config)),)
$(patsubst %.c,$B/obj/%.o,$(UNIT_C) $(GL_C) $(TOOLS_C) $(CLI_C) $(VIEWER_C)): own_mode = -O0
$(addprefix $B/obj/,tests/unit/test_acquire.o tests/unit/test_acquire_bad.o viewer/draw/btf_upload.o): own_mode = -O1
endif
comma := ,
TEST_LD := $(if $(shell command -v ld.gold),-fuse-ld=gold) $(if $(filter release,$(config)),-Wl$(comma)-S)

$B/obj/%.o: %.c | $(DEPS)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(C11) $(FRAMES) $(own_mode) -Iinclude $(own_include) $(own_flags) $(CFLAGS) -c -o $@ $<
$B/obj/%.o: %.cpp | $(DEPS)
	@mkdir -p $(@D)
	$(call say,CXX)
	$(Q)$(CXX) $(CXX17) -Iinclude $(own_include) $(own_flags) $(CXXFLAGS) -c -o $@ $<

$B/obj/src/core/kernel/lsq_eigen_%.o: src/core/kernel/lsq_eigen.cpp | $(DEPS)
	@mkdir -p $(@D)
	$(call say,CXX)
	$(Q)$(CXX) $(CXX17) -Iinclude -Isrc $(own_flags) $(CXXFLAGS) -c -o $@ $<
$(EIGEN_SHARED:%=$B/%): $B/%: src/core/kernel/lsq_eigen.cpp src/core/kernel/lsq_kernels.h | $(DEPS)
	@mkdir -p $(@D)
	$(Q)$(MAKE) -s config=release build/$*
	$(Q)cp build/$* $@

# The web viewer is modules in the tree, one classic script in a site, and bytes in the library.
$B/web/relume.js: scripts/join-web.sh $(WEB_JS) $(WEB_MORE)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/join-web.sh --more $(WEB_MORE) -- $(WEB_JS) > $@
$B/web/relume-more.js: scripts/join-web.sh $(WEB_MORE)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/join-web.sh --part $(WEB_MORE) > $@
$B/web/relume-object.js: scripts/join-web.sh $(WEB_OBJECT) $(WEB_SHARED)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/join-web.sh $(WEB_OBJECT) $(WEB_SHARED) > $@
$B/web/core.js: $(WEB_CORE)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q){ printf 'relume.putCore("'; base64 -w0 $<; printf '");\n'; } > $@
$B/obj/web/assets.c: scripts/embed-web.sh $B/web/relume.js $B/web/relume-more.js $B/web/relume-object.js $B/web/core.js $(WEB_CORE) $(WEB_OPEN) $(WEB_CSS)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/embed-web.sh $(foreach f,$(filter-out scripts/%,$^),$(notdir $f)=$f) > $@
$B/obj/web/assets.o: $B/obj/web/assets.c | $(DEPS)
	$(call say,CC)
	$(Q)$(CC) $(C11) -Isrc -c -o $@ $<

# Shaders are files in the tree and strings in the program.
$B/obj/viewer/shaders.c: scripts/embed.sh $(SHADERS)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/embed.sh viewer/shaders $(SHADERS) > $@
$B/obj/viewer/shaders.o: $B/obj/viewer/shaders.c | $(DEPS)
	$(call say,CC)
	$(Q)$(CC) $(C11) -Iviewer -c -o $@ $<

# ---------------------------------------------------------------- linking

$B/librelume.a: $(LIB_O)
	$(Q)rm -f $@
	$(call say,AR)
	$(Q)$(AR) rcs $@ $^
# The law of the wings, of symbols; that of includes: make layers
$B/layers.ok: $(LIB_O) scripts/layers.sh
	$(Q)scripts/layers.sh --symbols $(filter %.o,$^)
	@touch $@
# Where a program or library looks for the module: first where the build left it. Sanitizers open
# libraries in its name, which only the older kind of run path allows.
run_path = $(if $(filter no,$(RUN_PATH)),,'-Wl,-rpath,$$ORIGIN$1'$(if $(filter asan tsan fuzzer msan,$(config)),$(comma)--disable-new-dtags))
# Programs for ASan lie at a fixed place: half a million addresses within them would be worked out at each start.
FIXED := $(if $(filter asan,$(config)),-no-pie)
# Addresses of library functions are looked up at start and cannot be written over afterwards.
HARD_LD := -Wl,-z,relro,-z,now
$B/librelume.so: $(LIB_O)
	$(call say,LD)
	$(Q)$(CC) $(MODE) -shared -Wl,-soname,librelume.so.$(MAJOR) $(call run_path) $(HARD_LD) -o $@ $^ $(LDFLAGS) $(LIBS)
	$(Q)ln -sfn $(@F) $@.$(MAJOR)
	$(if $(STITCH),,@echo '  OpenCV is not there: built without stitching (make deps-stitch adds it)')
$(MODULE): $(MODULE_CXX:%.cpp=$B/obj/%.o) $B/librelume.a
	$(call say,LD)
	$(Q)$(CXX) $(MODE) -shared -Wl,--exclude-libs,ALL $(HARD_LD) -o $@ $^ $(LDFLAGS) $(OIIO_LIBS) $(LIBS)
$(MESHES): $(MESHES_C:%.c=$B/obj/%.o) $B/librelume.a
	$(call say,LD)
	$(Q)$(CC) $(MODE) -shared -Wl,--exclude-libs,ALL $(HARD_LD) -o $@ $^ $(LDFLAGS) -Wl,--as-needed -lassimp -lm
$(STITCH): $(STITCH_CXX:%.cpp=$B/obj/%.o)
	$(call say,LD)
	$(Q)$(CXX) $(MODE) -shared $(HARD_LD) -o $@ $^ $(LDFLAGS) -Wl,--as-needed -lopencv_stitching -lopencv_features2d -lopencv_calib3d -lopencv_imgproc -lopencv_core
$(HELPER): $(HELPER_C:%.c=$B/obj/%.o) $B/librelume.a | $(MODULE) $(MESHES)
	$(call say,LD)
	$(Q)$(LINK) $(MODE) -pthread $(call run_path) $(HARD_LD) $(FIXED) -o $@ $(filter %.o %.a,$^) $(LDFLAGS) -Wl,--gc-sections -Wl,--as-needed -lm -ldl
$B/relume: $(CLI_O) $B/librelume.a
	$(call say,LD)
	$(Q)$(CC) $(MODE) -pthread $(call run_path,:$$ORIGIN/../lib) $(HARD_LD) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(CLI_LIBS)
$B/relume-mpi: $(MPI_C:%.c=$B/obj/%.o) $(filter-out %/start.o,$(CLI_O)) $B/librelume.a
	$(call say,LD)
	$(Q)$(CC) $(MODE) -pthread $(call run_path,:$$ORIGIN/../lib) $(HARD_LD) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(CLI_LIBS) $(shell mpicc --showme:link)
$B/relume-view: $(VIEWER_O) $B/librelume.a
	$(call say,LD)
	$(Q)$(CXX) $(MODE) -pthread $(call run_path,:$$ORIGIN/../lib) $(HARD_LD) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(GL_LIBS)

$(filter-out $(THREADS),$(UNIT)): $B/tests/%: $B/obj/tests/%.o $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..) $(FIXED) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LDFLAGS) $(LIBS) $(CMOCKA)
# What the tool measures stands outside of the library.
$B/tests/unit/test_octree: $B/obj/src/cli/measure/octree.o
$B/tests/unit/test_reflected_places: $(addprefix $B/obj/src/cli/measure/,bezier.o triangle.o)
# The map of the linker says which sources of the library they take. For `make config=tsan check-threads` these are
# compiled and no others, half of all; a member that the release did not ask for is the release's.
TAKES := $(if $(filter tsan,$(config)),$(filter check-threads,$(MAKECMDGOALS)))
THREADS_LIB := $(if $(TAKES),$B/tests/threads/taken.a build/librelume.a,$B/librelume.a)
$(THREADS): $B/tests/%: $B/obj/tests/%.o $(THREADS_LIB)
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..) -Wl,-Map=$@.map $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(CMOCKA)
ifneq ($(TAKES),)
include $B/tests/threads/taken.mk
$B/tests/threads/taken.mk: $(THREADS:$B/%=%.c) $(LIB_C)
	@mkdir -p $(@D)
	$(Q)$(MAKE) -s config=release $(THREADS:$B/%=build/%)
	$(Q)sed -n 's/^build.librelume.a(\([^)]*\)).*/TAKEN += \1/p' $(THREADS:$B/%=build/%.map) | LC_ALL=C sort -u > $@
endif
$B/tests/threads/taken.a: $(foreach o,$(LIB_O),$(if $(filter $(notdir $o),$(TAKEN)),$o))
	$(Q)rm -f $@
	$(call say,AR)
	$(Q)$(AR) rcs $@ $^
# Benches that draw are linked as the tests of GL are.
GL_BENCH := $(addprefix $B/tests/bench/,bench_viewer bench_objects bench_seeing)
$(filter-out $(GL_BENCH),$(BENCH)) $(FUZZ): $B/tests/%: $B/obj/tests/%.o $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(LINK) $(MODE) $(TEST_LD) $(if $(CLANG),$(FUZZ_ENGINE)) -pthread $(call run_path,/../..) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LDFLAGS) $(LIBS) $(if $(@:%/fuzz_command=),,$(CLI_LIBS))
$(FUZZ): | $(MSAN_TOLD_O)
# The tool without its main
$B/tests/fuzz/fuzz_command: $(filter-out %/main.o %/start.o,$(CLI_O))
# The viewer without its window
$B/tests/fuzz/fuzz_script: $(filter $B/obj/viewer/app/% $B/obj/viewer/common/% $B/obj/src/cli/program/%,$(VIEWER_O))
$(TOOLS): $B/%: $B/obj/%.o $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..:$$ORIGIN/..) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS)
$(GL) $(GL_BENCH): $B/tests/%: $B/obj/tests/%.o $(filter-out %/main.o,$(VIEWER_O)) $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CXX) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(GL_LIBS) $(CMOCKA)

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

# Programs open the module when they run, but for the tests of threads.
$B/relume $(MPI) $B/relume-view $(filter-out $(THREADS),$(UNIT)) $(GL) $(BENCH) $(FUZZ) $(TOOLS): | $(MODULE) $(MESHES) $(HELPER)

-include $(shell find $B/obj -name '*.d' 2>/dev/null)
%.d: ;

# ---------------------------------------------------------------- checking

# `make test` is everything; `make check` is the part that one config runs.
test: all
	@tests/run.sh $(MAKE)
# Sanitizers run few scripts (tests/check.sh), none of which needs these.
check: all $(UNIT) $(GL) $(TOOLS) $(FAULTS) $B/tests/core.so $(if $(filter asan tsan,$(config)),,$(FUZZ) $(GROWN))
	@tests/check.sh $B
# Does every test still compile? A minute where check takes five.
compile-tests: $(patsubst %.c,$B/obj/%.o,$(UNIT_C) $(GL_C) $(TOOLS_C) $(FUZZ_C) $(BENCH_C))
check-threads: $(THREADS)
	@ONLY_BINARIES=1 tests/check.sh $B

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

# The sources in numbers
metrics:
	@scripts/metrics.sh

# What cppcheck finds is mended, or said to be none in scripts/lint.supp. Short names of vectors are
# for programs that use the library: with them every source would be looked at twice.
LINTED := src viewer
lint:
	@mkdir -p $B/lint
	@cppcheck -q -j2 --std=c11 --enable=warning,portability --suppressions-list=scripts/lint.supp --error-exitcode=1 \
	    --cppcheck-build-dir=$B/lint -URELUME_VEC3_SHORT -Uvec3_of \
	    -Iinclude -Isrc -Iviewer $(LINTED)

format:
	clang-format -i $(LIB_C) $(MODULE_CXX) src/core/kernel/lsq_eigen.cpp $(MESHES_C) $(STITCH_CXX) $(HELPER_C) $(wildcard src/cli/mpi/*.c) $(CLI_C) $(VIEWER_C) $(VIEWER_CXX) $(HEADERS) $(UNIT_C) $(GL_C) \
	    $(BENCH_C) $(FUZZ_C) $(TOOLS_C) $(wildcard src/*/*/*.h src/cli/*.h viewer/*/*.h tests/*.h tests/fuzz/*.h samples/*.c)

bench: all $(BENCH)
	@tests/bench/run.sh $B

fuzz: $(FUZZ)
	@for f in $(FUZZ); do $$f $(FUZZ_S) || exit 1; done
fuzzers: $(FUZZ)
# The seeds, and the inputs that once failed
replay: $(FUZZ)
	@for f in $(FUZZ); do $$f seeds $$(find tests/fuzz/corpus/$${f##*/} -type f 2>/dev/null) || exit 1; done

demo: all $B/samples/figures
	@scripts/demo.sh $B build/demo

# A site with a thing of each kind (docs/publish.md)
demo-web: cli
	@scripts/demo-web.sh $B build/demo-web

# A film of everything the viewer does: build/tour/film.mp4, or a folder of pictures without ffmpeg
tour: all
	@scripts/tour.sh $B build/tour

# The frames that tests/cli/test_golden.sh compares with, to be looked at before they are committed
golden: cli viewer
	@RELUME=$(CURDIR)/$B/relume VIEWER=$(CURDIR)/$B/relume-view TOP=$(CURDIR) BUILD=$(CURDIR)/$B STORE=1 tests/cli/test_golden.sh

# The pictures of docs/tutorials, by the commands that stand there
tutorials: cli samples
	@scripts/tutorials.sh pictures $B docs/pictures

# The pictures of docs/figures.md
figures: cli $B/samples/figures
	@scripts/figures.sh $B build/figures docs/pictures

# The reference of the library, docs/api/index.html; a public declaration without a comment is
# an error. Not part of make, since it needs Doxygen (make deps-docs).
.PHONY: docs deps-docs
docs:
	@doxygen scripts/Doxyfile
	@echo "  docs/api/index.html"

# ---------------------------------------------------------------- installing

install: all
	scripts/install.sh $B $(DESTDIR)$(PREFIX) $(PREFIX) $(LIBDIR)

# build/dist: the sources of the last commit as a tarball, the same bytes wherever it is made, with a
# list of what is in it (SPDX) and check sums
.PHONY: dist deb
dist:
	@scripts/dist.sh build/dist
# build/deb: Debian packages of that tarball; needs debhelper, dh-python and devscripts (docs/packaging.md)
deb: dist
	@scripts/deb.sh build/dist build/deb

clean:
	rm -rf build docs/api
