// write_materialx.c - maps as a MaterialX document: the gltf_pbr surface and a displacement
#include "material/maps/write.h"

static void put_image(FILE *f, const char *name, const char *type, const char *file,
                      const char *space)
{
    fprintf(f,
            "    <image name=\"%s\" type=\"%s\">\n"
            "      <input name=\"file\" type=\"filename\" value=\"%s\"%s%s%s />\n    </image>\n",
            name, type, file, space ? " colorspace=\"" : "", space ? space : "", space ? "\"" : "");
}

static void put_channel(FILE *f, const char *name, const char *from, const char *type, int channel)
{
    fprintf(f,
            "    <extract name=\"%s\" type=\"float\">\n"
            "      <input name=\"in\" type=\"%s\" nodename=\"%s\" />\n"
            "      <input name=\"index\" type=\"integer\" value=\"%d\" />\n    </extract>\n",
            name, type, from, channel);
}

static void put_graph(FILE *f, const struct writing *w)
{
    static const char *const output[][3] = {
        {"base_color", "color3", "base_rgb"},   {"alpha", "float", "alpha_of_base"},
        {"occlusion", "float", "occlusion_of"}, {"roughness", "float", "roughness_of"},
        {"metallic", "float", "metallic_of"},   {"normal", "vector3", "normal_of"},
        {"specular", "float", "specular_of"},   {"specular_color", "color3", "specular_scaled"},
        {"height", "float", "height_image"},
    };
    fputs("  <nodegraph name=\"NG_maps\">\n", f);
    put_image(f, "base_image", "color4", "basecolor.png", "srgb_texture");
    put_image(f, "orm_image", "vector3", "orm.png", NULL);
    put_image(f, "normal_image", "vector3", w->gl_normal, NULL);
    put_image(f, "specular_image", "color4", "specular.png", "srgb_texture");
    put_image(f, "height_image", "float", "height.exr", NULL);
    fputs("    <convert name=\"base_rgb\" type=\"color3\">\n"
          "      <input name=\"in\" type=\"color4\" nodename=\"base_image\" />\n    </convert>\n",
          f);
    put_channel(f, "alpha_of_base", "base_image", "color4", 3);
    put_channel(f, "occlusion_of", "orm_image", "vector3", 0);
    put_channel(f, "roughness_of", "orm_image", "vector3", 1);
    put_channel(f, "metallic_of", "orm_image", "vector3", 2);
    fputs("    <normalmap name=\"normal_of\" type=\"vector3\">\n"
          "      <input name=\"in\" type=\"vector3\" nodename=\"normal_image\" />\n"
          "    </normalmap>\n",
          f);
    put_channel(f, "specular_of", "specular_image", "color4", 3);
    fprintf(f,
            "    <convert name=\"specular_rgb\" type=\"color3\">\n"
            "      <input name=\"in\" type=\"color4\" nodename=\"specular_image\" />\n"
            "    </convert>\n    <multiply name=\"specular_scaled\" type=\"color3\">\n"
            "      <input name=\"in1\" type=\"color3\" nodename=\"specular_rgb\" />\n"
            "      <input name=\"in2\" type=\"float\" value=\"%.9g\" />\n    </multiply>\n",
            w->specular_most);
    for (size_t i = 0; i < sizeof output / sizeof *output; i++)
        fprintf(f, "    <output name=\"%s\" type=\"%s\" nodename=\"%s\" />\n", output[i][0],
                output[i][1], output[i][2]);
    fputs("  </nodegraph>\n", f);
}

static void put_input(FILE *f, const char *name, const char *type)
{
    fprintf(f, "    <input name=\"%s\" type=\"%s\" nodegraph=\"NG_maps\" output=\"%s\" />\n", name,
            type, name);
}

static void put_document(const void *context, FILE *f)
{
    const struct writing *w = context;
    const double to_metres = w->params->width_mm > 0.0 ? 0.001 : w->metres;
    fputs("<?xml version=\"1.0\"?>\n<materialx version=\"1.38\" colorspace=\"lin_rec709\">\n", f);
    put_graph(f, w);
    fputs("  <gltf_pbr name=\"SR_maps\" type=\"surfaceshader\">\n", f);
    put_input(f, "base_color", "color3");
    put_input(f, "metallic", "float");
    put_input(f, "roughness", "float");
    put_input(f, "normal", "vector3");
    put_input(f, "occlusion", "float");
    put_input(f, "specular", "float");
    put_input(f, "specular_color", "color3");
    if (w->masked) {
        put_input(f, "alpha", "float");
        fputs("    <input name=\"alpha_mode\" type=\"integer\" value=\"1\" />\n", f);
    }
    fputs("  </gltf_pbr>\n  <displacement name=\"DS_maps\" type=\"displacementshader\">\n"
          "    <input name=\"displacement\" type=\"float\" nodegraph=\"NG_maps\" "
          "output=\"height\" />\n",
          f);
    fprintf(f,
            "    <input name=\"scale\" type=\"float\" value=\"%.9g\" />\n  </displacement>\n"
            "  <surfacematerial name=\"maps\" type=\"material\">\n"
            "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"SR_maps\" />\n"
            "    <input name=\"displacementshader\" type=\"displacementshader\" "
            "nodename=\"DS_maps\" />\n  </surfacematerial>\n</materialx>\n",
            to_metres);
}

relume_status write_materialx(const struct writing *w)
{
    return write_text(w, "model.mtlx", put_document);
}
