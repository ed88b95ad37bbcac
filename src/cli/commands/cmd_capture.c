// cmd_capture.c - relume capture: from photographs to linear images with known lights
#include "commands/capture_hdr.h"
#include "commands/capture_lights.h"
#include "commands/capture_views.h"
#include "frame_options.h"

static const struct option options[] = {
    {"-o", OPTION_OUTPUT, "DIR", "the capture folder to make; with --hdr the picture OUT.exr", 0,
     0},
    // where the lights are
    {"--ball", OPTION_TEXT, "x,y,r",
     "outline of a mirror ball, pixels from the top left; may be repeated; default: found", 0, 0},
    {"--ball-photos", OPTION_TEXT, "PATH",
     "the ball was photographed separately: a folder, or a file (then repeated)", 0, 0},
    {"--ball-transfer", OPTION_TEXT, "T",
     "--ball-photos: linear, srgb or gamma:G; default: as --transfer, else by file", 0, 0},
    {"--balls", OPTION_INT, "N", "how many balls are to be found; default 1", 1, 16},
    {"--ball-mask", OPTION_TEXT, "FILE", "a mask: white where the ball is", 0, 0},
    {"--matte", OPTION_FLAG, NULL, "the ball is matte white, not a mirror", 0, 0},
    {"--lights", OPTION_TEXT, "FILE",
     "the lights are known: a .lp, .dome or capture.json file, lines x y z, or COLMAP poses of a "
     "camera on the lamp",
     0, 0},
    {"--near", OPTION_FLAG, NULL,
     "lights stand near: positions from two balls or more, or those of --lights", 0, 0},
    {"--ball-z", OPTION_NUMBER, "Z",
     "height of the balls' middle over the plane z = 0, world units; default 0", -1000, 1000},
    {"--fov", OPTION_NUMBER, "DEG", "horizontal field of view; default: orthographic", 0.1, 170},
    {"--focal", OPTION_NUMBER, "MM", "the same as a focal length for 36 mm wide film", 5, 5000},
    {"--refine-lights", OPTION_FLAG, NULL,
     "improve directions and intensities from the photographs themselves", 0, 0},
    {"--refine-brightness", OPTION_FLAG, NULL,
     "estimate each lamp's brightness from the photographs; directions stay", 0, 0},
    {"--integrable", OPTION_FLAG, NULL, "--refine-lights: keep the surface physically continuous",
     0, 0},
    {"--white", OPTION_TEXT, "x,y,w,h", "a region that is grey: the lamps' colour is divided out",
     0, 0},
    {"--flat", OPTION_TEXT, "PATH",
     "photograph of an even surface, divided out; one, or one under each light", 0, 0},
    {"--radial", OPTION_FLAG, NULL, "--flat: as a polynomial of the distance from the middle", 0,
     0},
    // what is made
    {"--mask", OPTION_TEXT, "FILE", "a mask: white where the object is", 0, 0},
    {"--normals", OPTION_FLOATS, "FILE.exr", "write surface normals", 0, 0},
    {"--albedo", OPTION_PICTURE, "FILE.exr", "write the surface's colour (albedo)", 0, 0},
    {"--height", OPTION_FLOATS, "FILE.exr", "write the surface's height, world units", 0, 0},
    {"--encode", OPTION_RELUME, "FILE.exr", "encode the capture as well", 0, 0},
    {"--relight", OPTION_PICTURE, "PICTURE", "and relight that by --light", 0, 0},
    LIGHT_OPTIONS,
    CPU_OPTION,
    {"--transfer", OPTION_TEXT, "T", "linear, srgb or gamma:G; default: by file", 0, 0},
    {"--force", OPTION_FLAG, NULL, "replace a folder that relume made", 0, 0},
    // brackets
    {"--hdr", OPTION_FLAG, NULL, "the photographs are exposures of one picture: merge them", 0, 0},
    {"--times", OPTION_TEXT, "FILE", "--hdr: exposure times, lines 'name seconds'", 0, 0},
    {"--response", OPTION_TEXT, "FILE", "--hdr: use this response curve of the camera", 0, 0},
    {"--save-response", OPTION_OUTPUT, "FILE", "--hdr: write the response that was found", 0, 0},
    {"--weights", OPTION_TEXT, "W", "--hdr: spline (default), hat or gaussian", 0, 0},
    {"--align", OPTION_TEXT, "A", "none, blocks or homography; default: none", 0, 0},
    {"--ghosts", OPTION_FLAG, NULL, "--hdr: leave out what moved between exposures", 0, 0},
    // many viewpoints
    CAPTURE_VIEWS_OPTIONS,
    // all
    {"--skip-bad", OPTION_FLAG, NULL, "leave out photographs that cannot be read or used", 0, 0},
    {"--json", OPTION_FLAG, NULL, "print one JSON object", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static relume_status run(const struct args *args)
{
    if (capture_views_asked(args))
        return capture_views(args);
    return args_has(args, "--hdr") ? capture_hdr(args) : capture_lights(args);
}

const struct command command_capture = {
    .name = "capture",
    .usage = "PHOTO... -o DIR|OUT.exr [OPTION ...]",
    .summary = "turn photographs into a capture and find their lights; or merge exposures (--hdr)",
    .example = "relume capture statue/*.jpg --ball-photos ball -o statue_capture",
    .min_inputs = 1,
    .max_inputs = 4096,
    .options = options,
    .run = run,
};
