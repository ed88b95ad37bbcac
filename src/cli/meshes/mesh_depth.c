// mesh_depth.c - relume mesh FILE.exr: the depth of all views as one surface
#include "cli/meshes/mesh_depth.h"

#include <stdlib.h>

static void print(const struct args *args, const struct mesh_made *made,
                  const struct relume_fusion_report *r, bool json)
{
    if (!json) {
        mesh_say(args, made);
        announce(args, RELUME_NOTE, "voxels of %.4g, %d x %d x %d", r->voxel, r->size[0],
                 r->size[1], r->size[2]);
        if (r->picture.data)
            announce(args, RELUME_NOTE,
                     "shows the relit views at %.1f dB PSNR, over %.1f %% of their surface",
                     r->psnr_db, 100.0 * r->shown);
        return;
    }
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    mesh_put_made(&w, made);
    jput_number(&w, "voxel", r->voxel, 9);
    jput_numbers(&w, "volume", (const double[]){r->size[0], r->size[1], r->size[2]}, 3, 0);
    jput_integer(&w, "unseen", (long long)r->unseen);
    if (r->picture.data) {
        jput_fixed(&w, "psnr_db", r->psnr_db, 4);
        jput_fixed(&w, "shown", r->shown, 6);
    }
    jend(&w);
}

static relume_status fuse(struct relume_mesh *mesh, struct relume_fusion_report *report,
                          const struct args *args, const struct depth_options *o, int block,
                          const struct relume_light *lights, int count)
{
    relume_pack *pack;
    struct prefix_log about;
    relume_status status = relume_open(
        &pack, args->input[0], relume_open_params(.log = args->log, .threads = args->threads));
    if (!status)
        status =
            relume_fusion(mesh, report, pack,
                          relume_fusion_params(.log = prefix_log(&about, args->log, args->input[0]),
                                               .threads = args->threads, .voxel = o->voxel,
                                               .farthest = o->farthest, .block = block,
                                               .no_colours = o->no_colours, .lights = lights,
                                               .texture = o->texture, .judge = o->texture > 0,
                                               .light_count = count));
    relume_pack_destroy(&pack);
    return status;
}

relume_status mesh_of_depth(const struct args *args, const struct depth_options *o, int block,
                            const char *output, bool json)
{
    const struct relume_mesh_params *p = relume_mesh_params(.log = args->log);
    struct relume_mesh mesh = {0};
    struct relume_fusion_report report = {.voxel = 0.0};
    relume_rig *rig = NULL;
    const struct relume_light *lights = NULL;
    int count = 0;
    char *png = o->texture ? mesh_picture_name(output) : NULL;
    relume_status status = relume_mesh_check(output, p);
    if (!status && o->texture)
        status = png ? relume_file_check(png, args->log) : RELUME_ENOMEM;
    if (!status && (o->lighting.light.count || o->lighting.rig))
        status = parse_lights(args, &o->lighting, &rig, &lights, &count);
    if (!status)
        status = fuse(&mesh, &report, args, o, block, lights, count);
    if (!status)
        status = report.picture.data
                     ? mesh_write_both(&mesh, output, &report.picture, png, args->log)
                     : relume_mesh_write(&mesh, output, p);
    if (!status)
        print(args,
              &(const struct mesh_made){.output = output,
                                        .mesh = &mesh,
                                        .seconds = report.seconds,
                                        .report = &report.mesh,
                                        .block = block},
              &report, json);
    relume_rig_destroy(&rig);
    relume_mesh_free(&mesh);
    relume_image_destroy(&report.picture);
    free(png);
    return status;
}
