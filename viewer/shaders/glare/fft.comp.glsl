#version 430
// Transforms of lines of complex numbers, in place, not normalised (Stockham's self-sorting FFT in
// shared memory; Cooley and Tukey 1965). One work group takes one line. Its program is made for one
// length, with LENGTH, THREADS and STAGES, a list of stage(radix, product of the radices before).
layout(local_size_x = THREADS) in;
layout(std430, binding = 0) buffer Lines { vec2 number[]; };
layout(std430, binding = 1) readonly buffer Turns { vec2 turn[]; };  // exp(-2 pi i k / LENGTH)
uniform int first;     // line
uniform ivec3 stride;  // from number to number, line to line, plane to plane
uniform float way;     // 1 forward, -1 inverse

shared vec2 line[LENGTH];
vec2 held[LENGTH / THREADS + 6];  // by this thread, until all have read

vec2 times(vec2 a, vec2 b)
{
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

vec2 turned(vec2 z, int k)
{
    return times(z, vec2(turn[k].x, way * turn[k].y));
}

void transform2(inout vec2 z[5])
{
    vec2 a = z[0];
    z[0] = a + z[1];
    z[1] = a - z[1];
}

void transform4(inout vec2 z[5])
{
    vec2 a = z[0] + z[2], b = z[0] - z[2], c = z[1] + z[3], d = z[1] - z[3];
    vec2 e = way * vec2(d.y, -d.x);
    z[0] = a + c;
    z[1] = b + e;
    z[2] = a - c;
    z[3] = b - e;
}

void transform_odd(int radix, inout vec2 z[5])
{
    vec2 sum[5];
    for (int q = 0; q < radix; q++) {
        sum[q] = z[0];
        for (int r = 1; r < radix; r++)
            sum[q] += turned(z[r], (q * r % radix) * (LENGTH / radix));
    }
    for (int q = 0; q < radix; q++)
        z[q] = sum[q];
}

void stage(int radix, int before)
{
    int me = int(gl_LocalInvocationID.x), count = LENGTH / radix, n = 0;
    for (int j = me; j < count; j += THREADS) {
        vec2 z[5];
        int k = j % before;
        for (int r = 0; r < radix; r++)
            z[r] = turned(line[j + r * count], r * k * (count / before));
        if (radix == 4)
            transform4(z);
        else if (radix == 2)
            transform2(z);
        else
            transform_odd(radix, z);
        for (int r = 0; r < radix; r++)
            held[n++] = z[r];
    }
    barrier();
    n = 0;
    for (int j = me; j < count; j += THREADS)
        for (int r = 0; r < radix; r++)
            line[(j / before) * before * radix + j % before + r * before] = held[n++];
    barrier();
}

void main()
{
    int at = (first + int(gl_WorkGroupID.x)) * stride.y + int(gl_WorkGroupID.y) * stride.z;
    int me = int(gl_LocalInvocationID.x);
    for (int i = me; i < LENGTH; i += THREADS)
        line[i] = number[at + i * stride.x];
    barrier();
    STAGES
    for (int i = me; i < LENGTH; i += THREADS)
        number[at + i * stride.x] = line[i];
}
