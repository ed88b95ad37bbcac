# relume - the build and what it installs. `make` builds, `make demo` and `make test` do all set-up by themselves.
#
#   make/sanitizers.mk   what config=asan, tsan, fuzzer and msan change
#   make/web.mk          the page of a published file
#   make/tests.mk        tests, benches, checks of the sources
#
#   config=release (default, into build/) | debug | coverage | asan | tsan | fuzzer | msan   (into build/CONFIG/)
#   FFT=fftw (default) | kiss   (a library without parts under the GPL; after make clean)
#   LIBDIR=lib (default)        where `make install` puts libraries, below PREFIX
#   RUN_PATH=no                 for packages: programs look for libraries where the system does, no more
#   V=1                         shows whole commands

config ?= release
FFT ?= fftw
PREFIX ?= /usr/local
LIBDIR ?= lib
Q := $(if $(V),,@)
say = $(if $(V),,@echo '  $1 $@')
comma := ,

B := $(if $(filter release,$(config)),build,build/$(config))
# The first number of the version names the shared library: librelume.so.0
MAJOR := $(shell sed -n 's/^.define RELUME_VERSION "\([0-9]*\)\..*/\1/p' include/relume/base.h)

.PHONY: all lib cli viewer samples deps deps-web deps-stitch deps-mpi deps-docs deps-python demo tour tutorials figures docs \
        install dist deb clean
.DELETE_ON_ERROR:
all: lib cli viewer samples $B/layers.ok

# ---------------------------------------------------------------- flags

CC       ?= gcc
CXX      ?= g++
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wvla -Wwrite-strings
COMMON   := -g -fPIC -fvisibility=hidden -MMD -MP -pthread -ffp-contract=off \
            -fno-math-errno -fno-trapping-math -ffile-prefix-map=$(CURDIR)=. $(WARNINGS)
# What stops hostile files should a reader of ours or of a library be wrong. Checked by test_build.sh.
release  := -O3 -DNDEBUG -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3 -fstack-protector-strong \
            -fstack-clash-protection
debug    := -O0
coverage := -O1 -g0 -DNDEBUG --coverage
MODE      = $($(config))
LINK      = $(CC)
# Threads may have stacks of 128 kB (docs/architecture.md); those of tests are large. Checked by test_build.sh.
FRAMES    = $(if $(filter release,$(config)),$(if $(filter $B/obj/tests/%,$@),,-Werror=frame-larger-than=98304))
C11       = -std=c11 -D_GNU_SOURCE $(COMMON) $(MODE) -Wstrict-prototypes -Wmissing-prototypes
CXX17     = -std=c++17 $(COMMON) $(MODE)

# Asked of pkg-config once, after the packages are there.
once     = $(eval $1 := $$(shell $2))$($1)
EXR      = $(call once,EXR,pkg-config --cflags OpenEXR)
OIIO     = $(call once,OIIO,pkg-config --cflags OpenImageIO)
IMGUI    = $(call once,IMGUI,pkg-config --cflags imgui)
GLFW     = $(call once,GLFW,pkg-config --cflags glfw3)
EIGEN    = $(call once,EIGEN,pkg-config --cflags eigen3)
CAIRO    = $(call once,CAIRO,pkg-config --cflags cairo)
FFT_PC   := $(if $(filter kiss,$(FFT)),kissfft-float,fftw3f)
PKG_LIBS = $(call once,PKG_LIBS,pkg-config --libs OpenEXR jansson libjpeg libpng lcms2 aom dav1d zlib $(FFT_PC))
OIIO_LIBS = $(call once,OIIO_LIBS,pkg-config --libs OpenImageIO)
LIBS     = -Wl,--as-needed $(PKG_LIBS) -lembree3 -lstdc++ -lm -ldl
CLI_LIBS = $(call once,CLI_LIBS,pkg-config --libs cairo)
GL_LIBS  = $(call once,GL_LIBS,pkg-config --libs glfw3 osmesa egl imgui)

# ---------------------------------------------------------------- sources

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
# The program in which foreign files are read and lossy planes coded (src/core/base/helper.h); it lies beside the modules
HELPER_C := $(wildcard src/cli/helper/*.c)
# The tool for all processes of an MPI launcher, built where one is (make deps-mpi); some packages
# bring mpicc without the header
MPI_C    := $(if $(shell echo 'int mpi;' | mpicc -include mpi.h -fsyntax-only -x c - 2>/dev/null && echo there),$(wildcard src/cli/mpi/*.c))
# src/cli/program is what the tool and the viewer share.
CLI_C    := $(filter-out src/cli/helper/% src/cli/mpi/%,$(wildcard src/cli/*.c src/cli/*/*.c))
VIEWER_C := $(wildcard src/cli/program/*.c viewer/*/*.c)
VIEWER_CXX := $(wildcard viewer/*/*.cpp)
SHADERS  := $(wildcard viewer/shaders/*.glsl viewer/shaders/*/*.glsl)
HEADERS  := $(wildcard include/relume/*.h include/relume/*/*.h)
# minimal.c, memory.c, batch.c and viewer.c are built against the installed library instead (tests/cli/test_install.sh)
SAMPLES_C := samples/sphere.c samples/figures.c samples/mirrorball.c

# Instruction sets beyond the baseline; what is written for another processor compiles to nothing.
# Where no compiler is yet (make deps gets one, later in this run), the machine says what it is.
AVX2     := $(if $(filter x86_64%,$(shell $(CC) -dumpmachine 2>/dev/null || uname -m)),-mavx2 -mfma -mf16c)
AVX512   := $(if $(AVX2),$(AVX2) -mavx512f -mavx512bw -mavx512dq -mavx512vl)
EIGEN_O  := $(addprefix $B/obj/src/core/kernel/lsq_eigen,.o $(if $(AVX2),_avx2.o _avx512.o))
LIB_O    := $(LIB_C:%.c=$B/obj/%.o) $B/obj/web/assets.o $(EIGEN_O)
MODULE   := $B/librelume-oiio.so.$(MAJOR)
MESHES   := $B/librelume-assimp.so.$(MAJOR)
STITCH   := $(if $(STITCH_CXX),$B/librelume-stitch.so.$(MAJOR))
HELPER   := $B/relume-helper
MPI      := $(if $(MPI_C),$B/relume-mpi)
CLI_O    := $(CLI_C:%.c=$B/obj/%.o)
VIEWER_O := $(VIEWER_C:%.c=$B/obj/%.o) $(VIEWER_CXX:%.cpp=$B/obj/%.o) $B/obj/viewer/shaders.o
VIEWER   := $B/relume-view
SAMPLES  := $(SAMPLES_C:%.c=$B/%)

lib: $B/librelume.a $B/librelume.so $(MODULE) $(MESHES) $(HELPER) $(STITCH)
cli: $B/relume $(MPI)
viewer: $(VIEWER)
samples: $(SAMPLES)

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
deps-stitch deps-mpi deps-docs deps-python:
	@scripts/deps.sh $(@:deps-%=%)

# ---------------------------------------------------------------- compiling

$B/obj/src/image/image/exr.o: own_flags = $(EXR)
$B/obj/src/image/image/oiio.o: own_flags = $(OIIO)
$B/obj/src/capture/multiview/stitch.o: own_flags = -isystem $(OPENCV)
$B/obj/src/core/base/module.o: own_flags = -DRELUME_MAJOR=$(MAJOR)
$B/obj/src/%_avx2.o: own_flags = $(AVX2)
$B/obj/src/%_avx512.o: own_flags = $(AVX512)
$B/obj/src/cli/plot.o: own_flags = $(CAIRO)
$B/obj/viewer/window/context_glfw.o: own_flags = $(GLFW)
$(MPI_C:%.c=$B/obj/%.o): own_flags = $(patsubst -I%,-isystem %,$(shell mpicc --showme:compile))
$(VIEWER_CXX:%.cpp=$B/obj/%.o): own_flags = $(IMGUI) -Wno-shadow
$B/obj/src/%.o:    own_include = -Isrc
$B/obj/viewer/%.o: own_include = -Iviewer -Isrc

$B/obj/%.o: %.c | $(DEPS)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(C11) $(FRAMES) $(own_mode) -Iinclude $(own_include) $(own_flags) $(CFLAGS) -c -o $@ $<
$B/obj/%.o: %.cpp | $(DEPS)
	@mkdir -p $(@D)
	$(call say,CXX)
	$(Q)$(CXX) $(CXX17) -Iinclude $(own_include) $(own_flags) $(CXXFLAGS) -c -o $@ $<

# One source, three objects: see its head. Without optimising Eigen is a hundred times slower, and its
# debug symbols are ten times the rest of the library. gcc 12 warns of its own headers (PR 105593).
eigen_mode  = -O2
eigen_flags = -isystem $(patsubst -I%,%,$(EIGEN)) $(eigen_mode) -g0 -DEIGEN_STACK_ALLOCATION_LIMIT=24576 -DEigen=eigen_$1 -DLSQ_KERNELS=lsq_kernels_$1
$B/obj/src/core/kernel/lsq_eigen.o: own_flags = $(call eigen_flags,plain)
$B/obj/src/core/kernel/lsq_eigen_avx2.o: own_flags = $(call eigen_flags,avx2) $(AVX2)
$B/obj/src/core/kernel/lsq_eigen_avx512.o: own_flags = $(call eigen_flags,avx512) $(AVX512) -Wno-uninitialized -Wno-maybe-uninitialized
$B/obj/src/core/kernel/lsq_eigen_%.o: src/core/kernel/lsq_eigen.cpp | $(DEPS)
	@mkdir -p $(@D)
	$(call say,CXX)
	$(Q)$(CXX) $(CXX17) -Iinclude -Isrc $(own_flags) $(CXXFLAGS) -c -o $@ $<

# Shaders are files in the tree and strings in the program.
$B/obj/viewer/shaders.c: scripts/embed.sh $(SHADERS)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/embed.sh viewer/shaders $(SHADERS) > $@
$B/obj/viewer/shaders.o: $B/obj/viewer/shaders.c | $(DEPS)
	$(call say,CC)
	$(Q)$(CC) $(C11) -Iviewer -c -o $@ $<

# ---------------------------------------------------------------- linking

# Where a program or library looks for the module: first where the build left it.
run_path = $(if $(filter no,$(RUN_PATH)),,'-Wl,-rpath,$$ORIGIN$1'$(OLD_RUN_PATH))
# Addresses of library functions are looked up at start and cannot be written over afterwards.
HARD_LD := -Wl,-z,relro,-z,now

$B/librelume.a: $(LIB_O)
	$(Q)rm -f $@
	$(call say,AR)
	$(Q)$(AR) rcs $@ $^
# The law of the wings, of symbols; that of includes: make layers
$B/layers.ok: $(LIB_O) scripts/layers.sh
	$(Q)scripts/layers.sh --symbols $(filter %.o,$^)
	@touch $@
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
	$(Q)$(LINK) $(MODE) -pthread $(call run_path) $(HARD_LD) $(FIXED) -o $@ $(filter %.o %.a,$^) $(LDFLAGS) -Wl,--gc-sections -Wl,--as-needed -laom -lm -ldl
$B/relume: $(CLI_O) $B/librelume.a
	$(call say,LD)
	$(Q)$(CC) $(MODE) -pthread $(call run_path,:$$ORIGIN/../lib) $(HARD_LD) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(CLI_LIBS)
$B/relume-mpi: $(MPI_C:%.c=$B/obj/%.o) $(filter-out %/start.o,$(CLI_O)) $B/librelume.a
	$(call say,LD)
	$(Q)$(CC) $(MODE) -pthread $(call run_path,:$$ORIGIN/../lib) $(HARD_LD) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(CLI_LIBS) $(shell mpicc --showme:link)
$B/relume-view: $(VIEWER_O) $B/librelume.a
	$(call say,LD)
	$(Q)$(CXX) $(MODE) -pthread $(call run_path,:$$ORIGIN/../lib) $(HARD_LD) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS) $(GL_LIBS)
$(SAMPLES): $B/%: $B/obj/%.o $B/librelume.a
	@mkdir -p $(@D)
	$(call say,LD)
	$(Q)$(CC) $(MODE) $(TEST_LD) -pthread $(call run_path,/../..:$$ORIGIN/..) $(FIXED) -o $@ $^ $(LDFLAGS) $(LIBS)
# Programs open the modules when they run.
$B/relume $(MPI) $(VIEWER) $(SAMPLES): | $(MODULE) $(MESHES) $(HELPER)

# ---------------------------------------------------------------- shown

demo: all $B/samples/figures
	@scripts/demo.sh $B build/demo

# A film of everything the viewer does: build/tour/film.mp4, or a folder of pictures without ffmpeg
tour: all
	@scripts/tour.sh $B build/tour

# The pictures of docs/tutorials, by the commands that stand there
tutorials: cli samples
	@scripts/tutorials.sh pictures $B docs/pictures

# The pictures of docs/figures.md
figures: cli $B/samples/figures
	@scripts/figures.sh $B build/figures docs/pictures

# The reference of the library, docs/api/index.html; a public declaration without a comment is
# an error. Not part of make, since it needs Doxygen (make deps-docs).
docs:
	@doxygen scripts/Doxyfile
	@echo "  docs/api/index.html"

# ---------------------------------------------------------------- installing

install: all
	scripts/install.sh $B $(DESTDIR)$(PREFIX) $(PREFIX) $(LIBDIR)

# build/dist: the sources of the last commit as a tarball, the same bytes wherever it is made, with a
# list of what is in it (SPDX) and check sums
dist:
	@scripts/dist.sh build/dist
# build/deb: Debian packages of that tarball; needs debhelper, dh-python and devscripts (docs/packaging.md)
deb: dist
	@scripts/deb.sh build/dist build/deb

clean:
	rm -rf build docs/api

include make/web.mk make/tests.mk make/sanitizers.mk
ifeq ($(MODE),)
$(error config=$(config): expected release, debug, coverage, asan, tsan, fuzzer or msan)
endif
-include $(shell find $B/obj -name '*.d' 2>/dev/null)
%.d: ;
