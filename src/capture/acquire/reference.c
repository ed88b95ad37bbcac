// reference.c - what the patches of a ColorChecker 24 are: X-Rite's values for charts made since
// November 2014 (L*a*b*, D50, 2 degrees, M0)
#include "capture/acquire/chart.h"

#include "core/base/infile.h"
#include "core/base/log.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double published[CHART_PATCHES][3] = {
    {37.54, 14.37, 14.92},  {64.66, 19.27, 17.50},   {49.32, -3.82, -22.54}, {43.46, -12.74, 22.72},
    {54.94, 9.61, -24.79},  {70.48, -32.26, -0.37},  {62.73, 35.83, 56.50},  {39.43, 10.75, -45.17},
    {50.57, 48.64, 16.67},  {30.10, 22.54, -20.87},  {71.77, -24.13, 58.19}, {71.51, 18.24, 67.37},
    {28.37, 15.42, -49.80}, {54.38, -39.72, 32.27},  {42.43, 51.05, 28.62},  {81.80, 2.67, 80.41},
    {50.63, 51.28, -14.12}, {49.57, -29.71, -28.32}, {95.19, -1.03, 2.93},   {81.29, -0.57, 0.44},
    {66.89, -0.75, -0.06},  {50.76, -0.13, 0.14},    {35.63, -0.46, -0.48},  {20.64, 0.07, -0.46},
};

static double from_curve(double f)
{
    return f > 6.0 / 29.0 ? f * f * f : (116.0 * f - 16.0) * 27.0 / 24389.0;
}

static double to_curve(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

void chart_lab(double lab[3], const double rgb[3])
{
    static const double xyz[3][3] = {
        {0.4124564 / 0.95047, 0.3575761 / 0.95047, 0.1804375 / 0.95047},
        {0.2126729, 0.7151522, 0.0721750},
        {0.0193339 / 1.08883, 0.1191920 / 1.08883, 0.9503041 / 1.08883}};
    double f[3];
    for (int i = 0; i < 3; i++)
        f[i] = to_curve(xyz[i][0] * rgb[0] + xyz[i][1] * rgb[1] + xyz[i][2] * rgb[2]);
    lab[0] = 116.0 * f[1] - 16.0;
    lab[1] = 500.0 * (f[0] - f[1]);
    lab[2] = 200.0 * (f[1] - f[2]);
}

void relume_chart_colours(double rgb[RELUME_CHART_PATCHES][3], const double (*reference)[3])
{
    // D50 -> linear sRGB with Bradford's adaptation, as image/image/profile.c
    static const double m[3][3] = {{3.1338561, -1.6168667, -0.4906146},
                                   {-0.9787684, 1.9161415, 0.0334540},
                                   {0.0719453, -0.2289914, 1.4052427}};
    reference = reference ? reference : published;
    for (int i = 0; i < CHART_PATCHES; i++) {
        const double fy = (reference[i][0] + 16.0) / 116.0;
        const double xyz[3] = {0.96422 * from_curve(fy + reference[i][1] / 500.0), from_curve(fy),
                               0.82521 * from_curve(fy - reference[i][2] / 200.0)};
        for (int c = 0; c < 3; c++)
            rgb[i][c] = m[c][0] * xyz[0] + m[c][1] * xyz[1] + m[c][2] * xyz[2];
    }
}

// The last three numbers of a line; false where they are no colour.
static bool parse_line(double lab[3], char *line)
{
    for (int i = 2; i >= 0; i--) {
        size_t end = strlen(line);
        while (end && strchr(" \t,;\r\n", line[end - 1]))
            line[--end] = '\0';
        size_t start = end;
        while (start && !strchr(" \t,;", line[start - 1]))
            start--;
        char rest;
        if (start == end || sscanf(line + start, "%lf%c", &lab[i], &rest) != 1)
            return false;
        line[start] = '\0';
    }
    return lab[0] >= 0.0 && lab[0] <= 110.0 && fabs(lab[1]) <= 200.0 && fabs(lab[2]) <= 200.0;
}

relume_status relume_chart_reference_load(double reference[RELUME_CHART_PATCHES][3],
                                          const char *path, const struct relume_log *log)
{
    FILE *file = input_open(path, log);
    if (!file)
        return relume_input_fail(log, path, "cannot be opened", errno);
    char line[512];
    int count = 0, number = 0, bad = 0;
    while (!bad && fgets(line, sizeof line, file)) {
        double extra[3] = {0.0, 0.0, 0.0};
        number++;
        line[strcspn(line, "#\r\n")] = '\0';
        if (!line[strspn(line, " \t")])
            continue;
        if (!parse_line(count < CHART_PATCHES ? reference[count] : extra, line))
            bad = number;
        count++;
    }
    fclose(file);
    if (bad)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: line %d; expected L*, a* and b* of a patch, L* from 0 to 110", path,
                        bad);
    if (count != CHART_PATCHES)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: %d colours; expected 24, row by row from dark skin to black", path,
                        count);
    return RELUME_OK;
}
