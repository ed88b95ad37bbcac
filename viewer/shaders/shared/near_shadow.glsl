// A near light whose shadows move: every pixel has a direction of its own, and captured lights of
// its own around it. After transfer, stage and moving. Twin: src/relight/shadow/shadows.c.
//
// The shader defines `Transfer display`, `lights` (directions of captured lights), pole_from_world
// and triangles_find, and:
vec3 captured(vec3 towards, out float share);  // where light is taken from, and the share of it
vec3 turned_back(vec3 towards);                // from the world to the view

const int SIDE = 4;    // of an area light's patches
const int ASKED = 16;  // captured lights that a pixel remembers
ivec2 at;
vec4 model;
int asked[ASKED], remembered = 0;
float answer[ASKED];

float quarter_share(vec3 towards, float distance)
{
    return 0.25 * float(quarters_reached(at, turned_back(towards), distance));
}

// What a captured light shows of the pixel. Patches ask for the same ones again.
float know(int light)
{
    for (int i = 0; i < remembered; i++)
        if (asked[i] == light)
            return answer[i];
    vec3 from = texelFetch(lights, ivec2(light, 0), 0).xyz;
    float known = quarter_share(from, BACKGROUND) * shadows_matte(model, from);
    if (remembered < ASKED) {
        asked[remembered] = light;
        answer[remembered++] = known;
    }
    return known;
}

// `index` is the patch of an area light, or -1.
float near_share(vec3 towards, float distance, int index)
{
    if (index < 0)
        return quarter_share(towards, distance);
    int quarter = (index + index / SIDE) & 3;
    return quarter_reached(at, quarter, turned_back(towards), distance) ? 1.0 : 0.0;
}

void add_near(inout vec3 lit, inout vec3 between, vec3 arriving, vec3 colour, vec3 towards,
              float distance, int index)
{
    float share;
    vec3 from = captured(towards, share), weight, codes = vec3(0.0);
    ivec3 node;
    triangles_find(node, weight, pole_from_world(from));
    for (int i = 0; i < 3; i++)
        if (weight[i] > 0.0)
            codes += weight[i] * transfer_encode(display, colour * know(node[i]));
    lit += share * arriving * colour * near_share(towards, distance, index) *
           shadows_matte(model, from);
    between += share * arriving * transfer_decode(display, codes);
}
