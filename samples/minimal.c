// minimal.c - load a relume file, light it from the right, save the picture
//
//     cc -std=c11 minimal.c $(pkg-config --cflags --libs relume) -o minimal
//     ./minimal statue.exr statue.png
#include <relume/relume.h>
#include <stdio.h>

static void say(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    fprintf(stderr, "minimal: %s\n", text);
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return fprintf(stderr, "usage: minimal FILE.exr OUT.png\n"), 2;
    const struct relume_log log = {.message = say};
    const struct relume_light lamp = {.direction = {1, 0.5, 1}, .rgb = {1, 1, 1}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_DEFAULT};
    struct relume_image picture = {0};
    relume_pack *pack;

    relume_status status = relume_pack_open(&pack, argv[1], relume_pack_params(.log = &log));
    if (!status)
        status = relume_frame(&picture, pack, &camera, &lamp, 1, relume_frame_params(.log = &log));
    if (!status)
        status = relume_image_save(&picture, argv[2], relume_image_params(.log = &log));
    if (status)
        fprintf(stderr, "minimal: %s\n", relume_status_text(status));
    relume_image_destroy(&picture);
    relume_pack_destroy(&pack);
    return status ? 1 : 0;
}
