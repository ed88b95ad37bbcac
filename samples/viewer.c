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

int main(int argc, char **argv)
{
    const struct relume_log log = {.message = say};
    const struct relume_camera camera = {0};
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
    const struct relume_target target = {.data =
                                             malloc((size_t)info->width * (size_t)info->height * 4),
                                         .format = RELUME_TARGET_RGBA8,
                                         .width = info->width,
                                         .height = info->height};
    glfwInit();
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    GLFWwindow *window = glfwCreateWindow(info->width, info->height, argv[1], NULL, NULL);
    if (!window || !target.data)
        return fprintf(stderr, "viewer: no window can be opened; is there a display?\n"), 3;
    glfwMakeContextCurrent(window);
    glRasterPos2f(-1.0f, 1.0f);  // relume's first row is the top, OpenGL's the bottom
    glPixelZoom(1.0f, -1.0f);
    for (; !glfwWindowShouldClose(window); glfwWaitEvents()) {
        const struct relume_light light = light_of_mouse(window);
        status = relume_renderer_set_lights(renderer, &light, 1);
        if (!status)
            status = relume_renderer_draw(renderer, &camera, &target);
        if (status)
            break;
        glDrawPixels(target.width, target.height, GL_RGBA, GL_UNSIGNED_BYTE, target.data);
        glfwSwapBuffers(window);
    }
    glfwTerminate();
    free(target.data);
    relume_renderer_destroy(&renderer);
    relume_pack_destroy(&pack);
    return status ? 1 : 0;
}
