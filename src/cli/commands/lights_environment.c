// lights_environment.c - weights of captured lights that add up to an environment, for programs
// that have pictures under each light and no more: w_k = the environment's light, shared among the
// lights around each direction (relume_environment_weights), which is what relight does with a
// table
#include "lights_environment.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 160 };

struct weighed {
    int lights;
    struct relume_vec3 *direction;
    float (*intensity)[3];  // of photographs as they are; NULL: all 1
    char (*name)[NAME];     // of their layers or photographs
    float (*weight)[3];
    bool hemispherical, pole_y;
};

static void destroy(struct weighed *w)
{
    free(w->direction);
    free(w->intensity);
    free(w->name);
    free(w->weight);
}

// ---------------------------------------------------------------- lights

static relume_status create(struct weighed *w, int lights)
{
    const size_t n = (size_t)lights;
    w->lights = lights;
    w->direction = calloc(n, sizeof *w->direction);
    w->intensity = calloc(n, sizeof *w->intensity);
    w->name = calloc(n, sizeof *w->name);
    w->weight = calloc(n, sizeof *w->weight);
    for (int i = 0; w->intensity && i < lights; i++)
        for (int c = 0; c < 3; c++)
            w->intensity[i][c] = 1.0f;
    return w->direction && w->intensity && w->name && w->weight ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status of_pack(struct weighed *w, const struct args *args, const char *path)
{
    relume_pack *pack;
    relume_status status =
        relume_open(&pack, path, relume_open_params(.log = args->log, .threads = args->threads));
    if (status)
        return status;
    const struct relume_coder_info *info = relume_coder_info(relume_pack_info(pack)->coder);
    status = create(w, info->lights);
    for (int i = 0; !status && i < info->lights; i++) {
        w->direction[i] = info->directions[i];
        snprintf(w->name[i], NAME, "light%0*d", info->lights > 10000 ? 5 : 4, i);
    }
    w->hemispherical = info->hemispherical;
    w->pole_y = info->pole_y;
    relume_pack_destroy(&pack);
    return status;
}

// "stage.exr: light0007" -> light0007, "view00/light0007.exr" -> light0007
static void name_of(char name[NAME], const char *image)
{
    const char *layer = strstr(image, ": ");
    const char *from = layer ? layer + 2 : path_name(image);
    const char *dot = layer ? NULL : strrchr(from, '.');
    snprintf(name, NAME, "%.*s", dot ? (int)(dot - from) : (int)strlen(from), from);
}

static relume_status of_capture(struct weighed *w, const struct args *args, const char *path)
{
    relume_capture *capture;
    relume_status status =
        relume_capture_open(&capture, path, relume_capture_params(.log = args->log));
    if (status)
        return status;
    const struct relume_manifest *m = relume_capture_manifest(capture);
    status = create(w, m->lights);
    for (int i = 0; !status && i < m->lights; i++) {
        w->direction[i] = m->directions[i];
        if (m->intensities)
            memcpy(w->intensity[i], m->intensities[i], sizeof *w->intensity);
        name_of(w->name[i], m->view[0].images[i]);
    }
    w->hemispherical = relume_capture_hemispherical(capture);
    w->pole_y = relume_capture_pole_y(capture);
    relume_capture_destroy(&capture);
    return status;
}

// ---------------------------------------------------------------- weights

static relume_status weigh_by(struct weighed *w, const struct args *args,
                              const struct relume_light *light)
{
    relume_coder *coder;
    relume_weight_grid *grid = NULL;
    const size_t n = (size_t)w->lights;
    float *sum = calloc(3 * n, sizeof *sum), constant[3] = {0.0f, 0.0f, 0.0f};
    relume_status status =
        !sum ? RELUME_ENOMEM
             : relume_coder_create(&coder, &relume_basis_table, w->direction, w->lights,
                                   relume_coder_params(.log = args->log, .decode = true,
                                                       .hemispherical = w->hemispherical,
                                                       .pole_y = w->pole_y));
    if (status) {
        free(sum);
        return status;
    }
    status = relume_weight_grid_create(
        &grid, coder, relume_weight_grid_params(.sums = true, .threads = args->threads));
    if (!status)
        relume_environment_weights(sum, constant, grid, light);
    for (size_t i = 0; !status && i < n; i++)
        for (size_t c = 0; c < 3; c++)
            w->weight[i][c] = sum[c * n + i] / w->intensity[i][c];
    relume_weight_grid_destroy(&grid);
    relume_coder_destroy(&coder);
    free(sum);
    return status;
}

static relume_status weigh(struct weighed *w, const struct args *args, const char *environment)
{
    const struct relume_light *lights;
    relume_rig *rig;
    int n;
    char spec[4200];
    snprintf(spec, sizeof spec, "env %s", environment);
    relume_status status = relume_rig_create(&rig);
    if (!status)
        status = relume_rig_add(rig, spec, NULL, args->log);
    if (!status)
        status = relume_rig_lights(&lights, &n, rig);
    if (!status)
        status = weigh_by(w, args, &lights[0]);
    relume_rig_destroy(&rig);
    return status;
}

// ---------------------------------------------------------------- what is printed

static void put_csv(FILE *f, const struct weighed *w)
{
    fputs("name,x,y,z,red,green,blue\n", f);
    for (int i = 0; i < w->lights; i++) {
        const struct relume_vec3 d = w->direction[i];
        const float *v = w->weight[i];
        if (strpbrk(w->name[i], ",\"\n"))
            fprintf(f, "light%d", i);
        else
            fputs(w->name[i], f);
        fprintf(f, ",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", d.x, d.y, d.z, (double)v[0], (double)v[1],
                (double)v[2]);
    }
}

static void print_json(const struct weighed *w, const struct environment_order *o)
{
    struct jwriter json = json_dense();
    jopen_object(&json, NULL);
    jput_text(&json, "environment", o->environment);
    jopen_array(&json, "lights");
    for (int i = 0; i < w->lights; i++) {
        jopen_object(&json, NULL);
        jput_text(&json, "name", w->name[i]);
        jput_vector(&json, "direction", w->direction[i], 9);
        jput_floats(&json, "weight", w->weight[i], 3, 9);
        jclose(&json);
    }
    jend(&json);
}

// As Nuke's reader of EXR calls a layer: digits before it are left out, what is no letter, digit or
// _ is _.
static const char *nuke_name(char out[NAME], const char *name)
{
    name += strspn(name, "0123456789");
    snprintf(out, NAME, "%s", name);
    for (char *c = out; *c; c++)
        if (!isalnum((unsigned char)*c))
            *c = '_';
    return out;
}

// One node to be pasted into Nuke's graph below the reader of the layers.
static void print_nuke(const struct weighed *w)
{
    static const char *const colours[] = {"red", "green", "blue"};
    char name[NAME];
    puts("Expression {");
    for (int c = 0; c < 3; c++) {
        printf(" expr%d \"", c);
        for (int i = 0; i < w->lights; i++)
            printf("%s%.7g*%s.%s", i ? " + " : "", (double)w->weight[i][c],
                   nuke_name(name, w->name[i]), colours[c]);
        puts("\"");
    }
    puts(" name Environment1\n label \"weights by relume\"\n}");
}

static void print_list(const struct weighed *w)
{
    puts("weights = [");
    for (int i = 0; i < w->lights; i++)
        printf("    (\"%s\", (%.7g, %.7g, %.7g)),\n", w->name[i], (double)w->weight[i][0],
               (double)w->weight[i][1], (double)w->weight[i][2]);
    puts("]");
}

// For its Script Editor, with the reader of the layers selected.
static void print_natron(const struct weighed *w)
{
    puts("# Natron: select the reader of the layers, paste this into the Script Editor and run it");
    print_list(w);
    puts("reader = app1.getSelectedNodes()[0]\n"
         "total = None\n"
         "for name, (red, green, blue) in weights:\n"
         "    layer = app1.createNode('net.sf.openfx.ShufflePlugin')\n"
         "    layer.connectInput(0, reader)\n"
         "    for letter in 'RGB':\n"
         "        layer.getParam('output' + letter).set('B.%s.%s' % (name, letter))\n"
         "    scaled = app1.createNode('net.sf.openfx.MultiplyPlugin')\n"
         "    scaled.getParam('value').set(red, green, blue, 1.0)\n"
         "    scaled.connectInput(0, layer)\n"
         "    if total is None:\n"
         "        total = scaled\n"
         "        continue\n"
         "    both = app1.createNode('net.sf.openfx.MergePlugin')\n"
         "    both.getParam('operation').set('plus')\n"
         "    both.connectInput(0, total)\n"
         "    both.connectInput(1, scaled)\n"
         "    total = both\n"
         "total.setLabel('Environment')");
}

// For its Text Editor or blender -P: nodes in the scene's compositor.
static void print_blender(const struct weighed *w, const char *file)
{
    puts("# Blender: run in the Text Editor; makes the compositor's nodes\n"
         "import bpy");
    printf("path = ");
    struct jwriter text = json_to(stdout);
    jput_text(&text, NULL, file);
    puts("  # the EXR of layers");
    print_list(w);
    puts("scene = bpy.context.scene\n"
         "scene.use_nodes = True\n"
         "tree = scene.node_tree\n"
         "tree.nodes.clear()\n"
         "reader = tree.nodes.new('CompositorNodeImage')\n"
         "reader.image = bpy.data.images.load(path)\n"
         "total = None\n"
         "for name, (red, green, blue) in weights:\n"
         "    scaled = tree.nodes.new('CompositorNodeMixRGB')\n"
         "    scaled.blend_type = 'MULTIPLY'\n"
         "    scaled.inputs[2].default_value = (red, green, blue, 1.0)\n"
         "    tree.links.new(reader.outputs[name], scaled.inputs[1])\n"
         "    if total is not None:\n"
         "        both = tree.nodes.new('CompositorNodeMixRGB')\n"
         "        both.blend_type = 'ADD'\n"
         "        tree.links.new(total.outputs[0], both.inputs[1])\n"
         "        tree.links.new(scaled.outputs[0], both.inputs[2])\n"
         "        scaled = both\n"
         "    total = scaled\n"
         "result = tree.nodes.new('CompositorNodeComposite')\n"
         "tree.links.new(total.outputs[0], result.inputs[0])");
}

// What a name is in a recipe: no program takes anything else in a layer's name.
static relume_status check_names(const struct weighed *w, const char *file, bool nuke)
{
    char own[NAME];
    static const char good[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
    for (int i = 0; i < w->lights; i++)
        if (!w->name[i][0] || w->name[i][strspn(w->name[i], good)])
            return data_error("%s: a layer is called '%.60s'; a recipe needs names of letters, "
                              "digits, _, - and .",
                              file, w->name[i]);
        else if (nuke && !*nuke_name(own, w->name[i]))
            return data_error("%s: a layer is called '%.60s', of which Nuke leaves nothing; "
                              "expected a letter in it",
                              file, w->name[i]);
    return RELUME_OK;
}

static void write_csv(const void *context, FILE *f)
{
    put_csv(f, context);
}

static relume_status show(const struct weighed *w, const struct args *args,
                          const struct environment_order *o)
{
    relume_status status =
        o->recipe ? check_names(w, o->file, o->recipe == RECIPE_NUKE) : RELUME_OK;
    if (!status && o->csv)
        status = relume_file_print(o->csv, write_csv, w, args->log);
    if (status)
        return status;
    if (o->recipe == RECIPE_NUKE)
        print_nuke(w);
    else if (o->recipe == RECIPE_NATRON)
        print_natron(w);
    else if (o->recipe == RECIPE_BLENDER)
        print_blender(w, o->file);
    else if (o->json)
        print_json(w, o);
    else if (!o->csv)
        put_csv(stdout, w);
    return RELUME_OK;
}

relume_status lights_environment(const struct args *args, const struct environment_order *order)
{
    struct weighed w = {0};
    const enum relume_kind kind = relume_kind_of(order->file);
    relume_status status =
        (kind == RELUME_KIND_CAPTURE ? of_capture : of_pack)(&w, args, order->file);
    if (!status)
        status = weigh(&w, args, order->environment);
    if (!status)
        status = show(&w, args, order);
    destroy(&w);
    return status;
}
