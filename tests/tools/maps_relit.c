// maps_relit.c - maps of a capture, and what the library itself shows of them under some lights
//
//   maps_relit CAPTURE DIR ['X Y Z' PNG ...]    writes the folder DIR and each PNG
#include "material/maps/maps.h"

#include <relume/extensions.h>

#include <stdio.h>

static relume_status relit(const struct relume_maps *maps, const char *light, const char *path)
{
    struct relume_vec3 direction;
    struct relume_image image = {0};
    if (sscanf(light, "%lf %lf %lf", &direction.x, &direction.y, &direction.z) != 3)
        return RELUME_EINVAL;
    relume_status status = relume_maps_relight(&image, maps, direction, 0);
    if (!status)
        status = relume_image_save(&image, path, NULL);
    relume_image_destroy(&image);
    return status;
}

int main(int argc, char **argv)
{
    struct relume_maps maps = {0};
    relume_capture *capture = NULL;
    relume_status status = argc < 3 ? RELUME_EINVAL : relume_capture_open(&capture, argv[1], NULL);
    if (!status)
        status = relume_maps_fit(&maps, capture, NULL);
    if (!status)
        status = relume_maps_write(&maps, argv[2], NULL);
    for (int i = 3; !status && i + 1 < argc; i += 2)
        status = relit(&maps, argv[i], argv[i + 1]);
    relume_maps_destroy(&maps);
    relume_capture_destroy(&capture);
    if (status)
        fprintf(stderr, "maps_relit: %s\n", relume_status_text(status));
    return status ? 1 : 0;
}
