# web.mk - the page of a published file: JavaScript modules and styles joined and embedded in the library, and
# the parts of the library that pages compute with, compiled to WebAssembly.

.PHONY: web demo-web

# What `relume publish` puts into every site; the core is compiled by make web
WEB_OBJECT := $(wildcard web/object*.js)
# ... what pages load when a file or a lamp needs it (web/more.js)
WEB_MORE := web/near.js web/pins.js $(wildcard web/moving*.js)
WEB_JS   := $(filter-out $(WEB_OBJECT) $(WEB_MORE),$(wildcard web/*.js))
# ... of which pages of objects have these, and nothing else
WEB_SHARED := $(addprefix web/,ball.js compare.js controls.js gl.js lights.js load.js marks.js noteindex.js notepanel.js notes.js overlay.js pins.js pointer.js profilegraph.js shaders.js stage.js \
              state.js wasm.js)
# ... and formulas that the viewer has, too
WEB_SHADERS := $(wildcard viewer/shaders/shared/*.glsl)
WEB_CORE := $(wildcard web/core/relume-core.wasm)
WEB_OPEN := $(wildcard web/open/relume-open.wasm web/open/licences.txt)
WEB_CSS  := $(wildcard web/*.css)

# The web viewer is modules in the tree, one classic script in a site, and bytes in the library.
$B/web/relume.js: scripts/join-web.sh $(WEB_JS) $(WEB_MORE) $(WEB_SHADERS)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/join-web.sh --more $(WEB_MORE) -- $(WEB_JS) > $@
$B/web/relume-more.js: scripts/join-web.sh $(WEB_MORE) $(WEB_SHADERS)
	@mkdir -p $(@D)
	$(call say,GEN)
	$(Q)scripts/join-web.sh --part $(WEB_MORE) > $@
$B/web/relume-object.js: scripts/join-web.sh $(WEB_OBJECT) $(WEB_SHARED) $(WEB_SHADERS)
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

# A site with a thing of each kind (docs/publish.md)
demo-web: cli
	@scripts/demo-web.sh $B build/demo-web
