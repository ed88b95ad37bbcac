# sanitizers.mk - what config=asan, tsan, fuzzer and msan change.

asan     := -O1 -g1 -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer
tsan     := -O1 -g1 -fsanitize=thread
# clang's libFuzzer with its sanitizers: make config=fuzzer fuzzers
fuzzer   := -O1 -g1 -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow \
            -fno-sanitize-recover=all -DRELUME_LIBFUZZER
# values used before they are set, in targets of libFuzzer: scripts/msan.sh, make config=msan fuzzers
msan     := -O1 -g1 -fsanitize=fuzzer-no-link,memory -fsanitize-memory-track-origins -fno-omit-frame-pointer \
            -fno-sanitize-recover=all -DRELUME_LIBFUZZER -DNO_MODULES

# ---------------------------------------------------------------- gcc's: asan, tsan

# Sanitizers open libraries in a program's name, which only the older kind of run path allows.
OLD_RUN_PATH := $(if $(filter asan tsan fuzzer msan,$(config)),$(comma)--disable-new-dtags)
# Programs for ASan lie at a fixed place: half a million addresses within them would be worked out at each start.
FIXED := $(if $(filter asan,$(config)),-no-pie)

ifneq ($(filter asan tsan,$(config)),)
# What takes time in programs is the library, but where a test makes its photographs itself, or the viewer looks
# for triangles.
$(patsubst %.c,$B/obj/%.o,$(UNIT_C) $(GL_C) $(TOOLS_C) $(CLI_C) $(VIEWER_C)): own_mode = -O0
$(addprefix $B/obj/,tests/unit/test_acquire.o tests/unit/test_acquire_bad.o viewer/draw/btf_upload.o): own_mode = -O1

# Eigen is looked at by ASan alone, and of its three objects that which most machines run: the others are the
# release's, since each takes half a minute to compile, for findings in Eigen.
ifeq ($(config),asan)
eigen_mode = -O1 -fno-sanitize=undefined
endif
EIGEN_SHARED := $(filter-out $(if $(filter asan,$(config)),%_avx2.o),$(EIGEN_O))
$(EIGEN_SHARED): $B/%: src/core/kernel/lsq_eigen.cpp src/core/kernel/lsq_kernels.h | $(DEPS)
	@mkdir -p $(@D)
	$(Q)$(MAKE) -s config=release build/$*
	$(Q)cp build/$* $@
endif

# `make config=tsan check-threads` compiles what of the library its tests take, which the linker's maps of the
# release say, half of all; a member that the release did not ask for is the release's.
TAKES := $(if $(filter tsan,$(config)),$(filter check-threads,$(MAKECMDGOALS)))
THREADS_LIB := $(if $(TAKES),$B/tests/threads/taken.a build/librelume.a,$B/librelume.a)
$(THREADS): $(THREADS_LIB)
ifneq ($(TAKES),)
include $B/tests/threads/taken.mk
$B/tests/threads/taken.mk: $(THREADS:$B/%=%.c) $(LIB_C)
	@mkdir -p $(@D)
	$(Q)$(MAKE) -s config=release $(THREADS:$B/%=build/%)
	$(Q)sed -n 's/^build.librelume.a(\([^)]*\)).*/TAKEN += \1/p' $(THREADS:$B/%=build/%.map) | LC_ALL=C sort -u > $@
$B/tests/threads/taken.a: $(foreach o,$(LIB_O),$(if $(filter $(notdir $o),$(TAKEN)),$o))
	$(Q)rm -f $@
	$(call say,AR)
	$(Q)$(AR) rcs $@ $^
endif

# ---------------------------------------------------------------- clang's: fuzzer, msan

ifneq ($(filter fuzzer msan,$(config)),)
CC       := clang
CXX      := clang++
# clang's checks of C++ (function, vptr) want its C++ runtime in the program
LINK     := $(CXX)
FUZZ_ENGINE ?= -fsanitize=fuzzer
endif

ifeq ($(config),msan)
# The C libraries built for it; of the others tests/tools/preload/msan.c tells.
MSAN_TOLD := nftw rtcNewDevice rtcReleaseDevice rtcCommitGeometry rtcCommitScene rtcReleaseScene rtcIntersect1 rtcOccluded16 \
             $(addprefix dav1d_,default_settings open close data_wrap send_data get_picture picture_unref) \
             $(addprefix aom_,codec_enc_config_default codec_enc_init_ver codec_enc_config_set img_alloc codec_encode \
             codec_get_cx_data codec_destroy)
MSAN_TOLD_O := $B/obj/tests/tools/preload/msan.o
PKG_LIBS  = $(MSAN_TOLD:%=-Wl,--wrap=%) $(MSAN_TOLD_O) -L$B/lib -l:libOpenEXRCore.a -ljansson -ljpeg -lpng -llcms2 -lz \
            -lImath-3_1 -laom -ldav1d -lfftw3f
$(FUZZ): | $(MSAN_TOLD_O)
endif
