// fuzz_objects.c - descriptions of objects and meshes (OBJ, PLY) made of noise; what is accepted is
// rendered, where every value must be finite. Models that Assimp reads are its own affair.
#include "fuzz_look.h"

static const char *const words[] = {"format",      "version",     "relume-objects",
                                    "objects",     "mesh",        "pose",
                                    "translate",   "rotate",      "scale",
                                    "parts",       "part",        "repeat",
                                    "offset",      "filter",      "material",
                                    "nearest",     "bilinear",    "btf",
                                    "input.obj",   "input.ply",   "vt",
                                    "vn",          "usemtl",      "f ",
                                    "1e308",       "-0",          "nan",
                                    "inf",         "1e-300",      "element",
                                    "property",    "list",        "uchar",
                                    "int",         "ascii",       "vertex",
                                    "face",        "4096",        "[",
                                    "]",           "{",           "}",
                                    ",",           "null",        "mirror",
                                    "reflections", "constraints", "regions",
                                    "position",    "eye",         "direction",
                                    "target",      "original",    "ball",
                                    "geodesic",    "stroke",      "radius",
                                    "border",      "distance",    "frozen",
                                    "billboards",  "baked",       "red",
                                    NULL};

static const char *const extensions[] = {"json", "obj", "ply"};

// A seed begins with the kind of its file.
static bool one(struct fuzz *f, struct bytes b)
{
    char path[128], material[128];
    const size_t kind = b.data[0] % 3;
    const char *materials[1] = {material};
    relume_objects *o;
    snprintf(path, sizeof path, "%s/input.%s", f->folder, extensions[kind]);
    snprintf(material, sizeof material, "%s/btf", f->folder);
    fuzz_store(path, (struct bytes){b.data + 1, b.size - 1});
    const relume_status status = kind == 0
                                     ? relume_objects_open(&o, path, NULL)
                                     : relume_objects_of_mesh(&o, path, materials, 1, 1.0, NULL);
    if (!status)
        look(o);
    relume_objects_destroy(&o);
    return !status;
}

static void add(struct fuzz *f, size_t kind, const char *text)
{
    struct bytes b = {malloc(strlen(text) + 2), strlen(text) + 1};
    b.data[0] = (uint8_t)kind;
    memcpy(b.data + 1, text, b.size);
    fuzz_add(f, b);
}

int main(int argc, char **argv)
{
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 .5\nvt 0 0\nvt 1 0\nvt 0 1\n"
                              "vn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/3/1\ng b\nf -1 -2 -3\n";
    struct fuzz f = {.words = words};
    char path[128];
    fuzz_begin(&f, "fuzz_objects", argc, argv);
    make_material(&f);
    snprintf(path, sizeof path, "%s/good.obj", f.folder);
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)obj, sizeof obj - 1});
    add(&f, 0,
        "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"good.obj\","
        "\"pose\":{\"translate\":[1,2,3],\"rotate\":[0,1,0,30],\"scale\":2},\"parts\":["
        "{\"part\":\"a\",\"material\":\"btf\",\"repeat\":[2,3],\"offset\":0.5},"
        "{\"material\":[\"btf\",\"btf\"],\"filter\":\"nearest\"}]}]}");
    add(&f, 0,
        "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"good.obj\","
        "\"parts\":[{\"material\":{\"mirror\":[1,0.5,0]}}],\"reflections\":{\"distance\":"
        "\"geodesic\",\"frozen\":[0,0,9],\"constraints\":[{\"position\":[0.2,0.2,0],\"eye\":"
        "[0.2,0.2,5],\"direction\":[1,0,0]},{\"position\":[0.3,0.2,0],\"eye\":[0.2,0.2,5],"
        "\"original\":[0,0,1],\"target\":[3,2,1]}],\"regions\":[{\"ball\":[0,0,0],\"radius\":1},"
        "{\"geodesic\":[0,0,0],\"radius\":1,\"border\":2},{\"stroke\":[[0,0,0],[1,0,0]],"
        "\"radius\":0.1,\"border\":0.5}]}}]}");
    add(&f, 0,
        "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"good.obj\","
        "\"billboards\":0.1,\"parts\":[{\"material\":{\"diffuse\":0.5}}]}]}");
    add(&f, 1, obj);
    add(&f, 1,
        "v 0 0 0 1 0 0\nv 1 0 0 0 .5 1\nv 0 1 0 .1 .2 .3\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n"
        "f 1/1/1 2/2/1 3/3/1\n");
    add(&f, 2,
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty float s\nproperty float t\nproperty uchar red\n"
        "property uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 0 0 255 0 0 255\n"
        "1 0 0 1 0 0 255 0 9\n0 1 0 0 1 7 8 9 0\n3 0 1 2\n");
    add(&f, 2,
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty float s\nproperty float t\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n"
        "1 1 1 1 1\n3 0 1 2\n3 1 3 2\n");
    return fuzz_run(&f, argc, argv, one);
}
