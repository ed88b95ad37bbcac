// memory.c - pictures in memory become a relume file in memory, which is opened, relit and
// exported: no file is touched
//
//     cc -std=c11 memory.c $(pkg-config --cflags --libs relume) -lm -o memory
//     ./memory
#include <math.h>
#include <relume/format/coder.h>
#include <relume/image/directions.h>
#include <relume/relume.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 64, LIGHTS = 16 };

// A matte ball of albedo 0.8 on black, under a light of value 1.
static float ball(int x, int y, struct relume_vec3 light)
{
    const double u = (x + 0.5) / SIDE * 2.2 - 1.1, v = 1.1 - (y + 0.5) / SIDE * 2.2;
    const double w = sqrt(fmax(1.0 - u * u - v * v, 0.0));
    return w > 0.0 ? (float)(0.8 * fmax(u * light.x + v * light.y + w * light.z, 0.0)) : 0.0f;
}

int main(void)
{
    static float pictures[LIGHTS][SIDE][SIDE];
    struct relume_vec3 lights[LIGHTS];
    struct relume_buffer file = {0}, png = {0}, rti = {0};
    struct relume_image picture = {0};
    relume_capture *capture = NULL;
    relume_pack *pack = NULL;

    relume_status status = relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"),
                                                  relume_directions_params(.hemisphere = true));
    for (int i = 0; !status && i < LIGHTS; i++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                pictures[i][y][x] = ball(x, y, lights[i]);

    // encode: an array [light][y][x] and where each light stood
    const struct relume_manifest manifest = {.lights = LIGHTS, .directions = lights};
    const struct relume_pictures array = {
        .width = SIDE, .height = SIDE, .channels = 1, .data = pictures};
    const struct relume_writer to_file = relume_buffer_writer(&file);
    if (!status)
        status = relume_capture_create(&capture, &manifest, &array, NULL);
    if (!status)
        status = relume_encode_capture(
            NULL, capture, NULL,
            relume_encode_capture_params(.basis = &relume_basis_sh, .writer = &to_file));

    // relight: the file lies in `file`, which must outlive the pack
    const struct relume_reader from_file = relume_memory_reader(file.data, file.size);
    const struct relume_light lamp = {.direction = {1, 0.5, 1}, .rgb = {1, 1, 1}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_DEFAULT};
    if (!status)
        status = relume_open(&pack, NULL, relume_open_params(.reader = &from_file));
    if (!status)
        status = relume_frame(&picture, pack, &camera, &lamp, 1, NULL);

    // a PNG in memory, as a web server would send it
    const struct relume_writer to_png = relume_buffer_writer(&png);
    if (!status)
        status = relume_image_save(&picture, "ball.png", relume_image_params(.writer = &to_png));
    // an RTI for other programs
    const struct relume_writer to_rti = relume_buffer_writer(&rti);
    if (!status)
        status = relume_export(pack, NULL, RELUME_EXCHANGE_RTI, NULL,
                               relume_export_params(.writer = &to_rti));
    if (!status) {
        const struct relume_vec3 l = {2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0};
        const double got = picture.data[3 * (SIDE / 2 * SIDE + SIDE / 2)];
        printf("%zu bytes encoded, a PNG of %zu bytes, an RTI of %zu; the middle is %.3f, the ball "
               "itself %.3f\n",
               file.size, png.size, rti.size, got, (double)ball(SIDE / 2, SIDE / 2, l));
    } else {
        fprintf(stderr, "memory: %s\n", relume_status_text(status));
    }
    relume_image_destroy(&picture);
    relume_pack_destroy(&pack);
    relume_capture_destroy(&capture);
    relume_buffer_destroy(&file);
    relume_buffer_destroy(&png);
    relume_buffer_destroy(&rti);
    return status ? 1 : 0;
}
