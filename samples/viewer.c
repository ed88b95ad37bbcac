// viewer.c - a window in which the mouse is the light
//
//     cc -std=c11 viewer.c $(pkg-config --cflags --libs relume glfw3 gl) -o viewer
//     ./viewer statue.exr
#include <GLFW/glfw3.h>
#include <math.h>
#include <relume/relume.h>
#include <stdio.h>
#include <stdlib.h>

static void say(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    fprintf(stderr, "viewer: %s\n", text);
}

// The window is the half sphere of lights as seen from above: its middle is straight ahead.
static struct relume_light light_of_mouse(GLFWwindow *window)
{
    int width, height;
    double x, y;
    glfwGetWindowSize(window, &width, &height);
    glfwGetCursorPos(window, &x, &y);
    x = fmin(fmax(2.0 * x / width - 1.0, -1.0), 1.0);
    y = fmin(fmax(1.0 - 2.0 * y / height, -1.0), 1.0);
    const double z = sqrt(fmax(1.0 - x * x - y * y, 0.01));
    return (struct relume_light){.direction = {x, y, z}, .rgb = {1, 1, 1}};
}

static relume_status draw(GLFWwindow *window, relume_renderer *renderer, const void *pixels,
                          const struct relume_target *target)
{
    const struct relume_light light = light_of_mouse(window);
    relume_status status = relume_renderer_set_lights(renderer, &light, 1);
    if (!status)
        status = relume_renderer_draw(renderer, &(struct relume_camera){0}, target);
    if (status)
        return status;
    glRasterPos2f(-1.0f, -1.0f);
    glDrawPixels(target->width, target->height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    glfwSwapBuffers(window);
    return RELUME_OK;
}

int main(int argc, char **argv)
{
    const struct relume_log log = {.message = say};
    relume_pack *pack = NULL;
    relume_renderer *renderer = NULL;
    if (argc != 2)
        return fprintf(stderr, "usage: viewer FILE.exr\n"), 2;
    relume_status status = relume_open(&pack, argv[1], relume_open_params(.log = &log));
    if (!status)
        status = relume_renderer_create(&renderer, pack, relume_frame_params(.log = &log));
    if (status)
        return 1;
    const struct relume_pack_info *info = relume_pack_info(pack);
    const int width = info->width, height = info->height, row = 4 * width;
    unsigned char *pixels = malloc((size_t)row * (size_t)height);
    glfwInit();
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    GLFWwindow *window = glfwCreateWindow(width, height, argv[1], NULL, NULL);
    if (!window || !pixels)
        return fprintf(stderr, "viewer: no window can be opened; is there a display?\n"), 3;
    glfwMakeContextCurrent(window);
    // OpenGL begins with the lowest row: the rows go upwards from the last.
    const struct relume_target target = {.data = pixels + (size_t)row * (size_t)(height - 1),
                                         .format = RELUME_TARGET_RGBA8,
                                         .width = width,
                                         .height = height,
                                         .stride = -row};
    for (; !status && !glfwWindowShouldClose(window); glfwWaitEvents())
        status = draw(window, renderer, pixels, &target);
    glfwTerminate();
    free(pixels);
    relume_renderer_destroy(&renderer);
    relume_pack_destroy(&pack);
    return status ? 1 : 0;
}
