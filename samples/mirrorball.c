// mirrorball.c - turns a planar capture of `relume synth` into photographs as a camera would take
// them: JPEG files beside whose subject a mirror ball shows the lamp, and nothing that says where
// the lamps were. Uses the public headers only.
//
//     mirrorball CAPTURE FOLDER      for example: relume synth bust -o bust; mirrorball bust photos
#define RELUME_VEC3_SHORT
#include <relume/extensions.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

// The ball, in parts of the picture's width and height: middle and radius. It mirrors a room that
// is brighter above than below, and a lamp that is some degrees wide, as a softbox far away.
static const double ball_x = 0.14, ball_y = 0.86, ball_radius = 0.1;
static const double lamp_sharpness = 150.0, lamp_value = 30.0;

// What the ball shows where its unit normal is `n`: the camera is far away, along +z.
static float reflected(vec3 n, vec3 lamp)
{
    const vec3 mirrored = {2.0 * n.z * n.x, 2.0 * n.z * n.y, 2.0 * n.z * n.z - 1.0};
    const double room = 0.12 + 0.06 * mirrored.y;
    return (float)(room + lamp_value * exp(lamp_sharpness * (vec3_dot(mirrored, lamp) - 1.0)));
}

static void paint_ball(struct relume_image *photograph, vec3 lamp)
{
    const double width = photograph->width, radius = ball_radius * width;
    const double x0 = ball_x * width, y0 = ball_y * photograph->height;
    for (int y = 0; y < photograph->height; y++)
        for (int x = 0; x < photograph->width; x++) {
            const double right = (x + 0.5 - x0) / radius, up = (y0 - y - 0.5) / radius;
            const double rest = 1.0 - right * right - up * up;
            float *pixel =
                photograph->data + 3 * ((size_t)y * (size_t)photograph->width + (size_t)x);
            for (int c = 0; rest > 0.0 && c < 3; c++)
                pixel[c] = reflected((vec3){right, up, sqrt(rest)}, lamp);
        }
}

static relume_status photograph(const relume_capture *capture, int light, const char *folder)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/photo%02d.jpg", folder, light + 1);
    struct relume_image image;
    relume_status status = relume_capture_image(&image, capture, 0, light, NULL);
    if (!status) {
        paint_ball(&image, relume_capture_manifest(capture)->directions[light]);
        status = relume_image_save(&image, path, NULL);
    }
    relume_image_destroy(&image);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return fprintf(stderr, "usage: mirrorball CAPTURE FOLDER\n"), 2;
    if (mkdir(argv[2], 0777) && errno != EEXIST)
        return perror(argv[2]), 3;
    relume_capture *capture;
    relume_status status = relume_capture_open(&capture, argv[1], NULL);
    const int lights = status ? 0 : relume_capture_manifest(capture)->lights;
    for (int i = 0; !status && i < lights; i++)
        status = photograph(capture, i, argv[2]);
    if (status)
        fprintf(stderr, "mirrorball: %s\n", relume_status_text(status));
    relume_capture_destroy(&capture);
    return status ? 1 : 0;
}
