// ten_calls.c - a capture becomes a file, a picture, an RTI and a web site: the core of the API
//
//     cc -std=c11 ten_calls.c $(pkg-config --cflags --libs relume) -o ten_calls
//     ./ten_calls statue/ out        # out.exr, out.png, out.rti, out-site/
#include <relume/relume.h>
#include <stdio.h>

static void say(void *user, enum relume_level level, const char *text)
{
    (void)user;
    fprintf(stderr, "ten_calls: %s%s\n", level == RELUME_WARNING ? "warning: " : "", text);
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return fprintf(stderr, "usage: ten_calls CAPTURE NAME\n"), 2;
    const struct relume_log log = {.message = say};
    char file[1024], picture[1024], rti[1024], site[1024];
    snprintf(file, sizeof file, "%s.exr", argv[2]);
    snprintf(picture, sizeof picture, "%s.png", argv[2]);
    snprintf(rti, sizeof rti, "%s.rti", argv[2]);
    snprintf(site, sizeof site, "%s-site", argv[2]);

    relume_capture *capture = NULL;
    relume_pack *pack = NULL;
    relume_rig *rig = NULL;
    relume_renderer *renderer = NULL;
    struct relume_image image = {0};
    struct relume_evaluation quality = {0};
    relume_status status;

    // 1. Open the photographs: capture.json, its folder, or a .lp file.
    if ((status = relume_capture_open(&capture, argv[1], relume_capture_params(.log = &log))))
        goto done;
    // 2. Encode them. What the params leave open is chosen by the photographs.
    if ((status =
             relume_encode_capture(file, capture, NULL, relume_encode_capture_params(.log = &log))))
        goto done;
    // 3. Open the file.
    if ((status = relume_open(&pack, file, relume_open_params(.log = &log))))
        goto done;
    // 4. Make a set of lights.
    if ((status = relume_rig_create(&rig)) ||
        (status = relume_rig_add(rig, "dir 1 0.5 1 rgb 1 0.9 0.8", NULL, &log)))
        goto done;
    // 5. Make a renderer of the file, under these lights.
    if ((status = relume_renderer_create(&renderer, pack, relume_frame_params(.log = &log))) ||
        (status = relume_renderer_set_rig(renderer, rig)))
        goto done;
    // 6. Draw a frame. A zeroed camera is the default one of the file.
    if ((status = relume_renderer_frame(&image, renderer, &(struct relume_camera){0})))
        goto done;
    // 7. Save it; the name's ending says the format.
    if ((status = relume_image_save(&image, picture, relume_image_params(.log = &log))))
        goto done;
    // 8. Compare the file with every photograph.
    if ((status = relume_evaluate(&quality, pack, capture, relume_evaluate_params(.log = &log))))
        goto done;
    printf("%d lights, PSNR %.1f dB\n", quality.lights, quality.psnr_db);
    // 9. Export it for another program.
    if ((status = relume_export(pack, rti, RELUME_EXCHANGE_RTI, NULL,
                                relume_export_params(.log = &log))))
        goto done;
    // 10. Publish it as a web site.
    status = relume_publish_files(site, (const char *[]){file}, 1,
                                  relume_publish_params(.log = &log), NULL);
done:
    if (status)
        fprintf(stderr, "ten_calls: %s\n", relume_status_text(status));
    relume_evaluation_destroy(&quality);
    relume_image_destroy(&image);
    relume_renderer_destroy(&renderer);
    relume_rig_destroy(&rig);
    relume_pack_destroy(&pack);
    relume_capture_destroy(&capture);
    return status ? 1 : 0;
}
