# docs.awk - a header's plain comments as Doxygen reads them (the INPUT_FILTER of scripts/Doxyfile).
#
# A comment on lines of its own belongs to the declaration below it, up to a blank line; one at the
# end of a line, and what goes on below it in its column, to what stands before it. So:
#     // text          ->  /// text
#     int n;  // text  ->  int n;  ///< text
# A member of several names (`int width, height;  // pixels`) is split, so that each has the text;
# What is the same in every header is said once, in base.h, and given here to each declaration that
# has no text of its own: `log`, `limits` and `threads`, structs of parameters, destroy.
BEGIN {
    standing["log"] = "Where sentences and progress go; borrowed. NULL: nowhere."
    standing["limits"] = "Bounds on what is read; borrowed. NULL: the defaults of struct relume_limits."
    standing["threads"] = "Number of threads; 0: all cores. Results do not depend on it."
    standing["force"] = "Replace an existing folder."
    standing["user"] = "Handed back to the functions beside it."
    standing["name"] = "As people write it; constant."
    standing["width"] = standing["height"] = "In pixels, or texels."
    standing["x"] = standing["y"] = standing["z"] = "A coordinate."
    standing["left"] = standing["top"] = "Of the upper left corner."
    standing["views"] = standing["lights"] = standing["planes"] = standing["books"] = "How many there are."
    standing["points"] = standing["triangles"] = standing["columns"] = standing["rows"] = "How many there are."
    standing["rings"] = standing["pixels"] = standing["pictures"] = standing["count"] = "How many there are."
    standing["codes"] = standing["balls"] = standing["warnings"] = standing["parts"] = "How many there are."
    standing["materials"] = standing["coefficients"] = standing["taps"] = standing["fines"] = "How many there are."
    standing["codes"] = "How many code vectors."
    standing["dim"] = "Numbers of a vector."
    standing["seed"] = "Of the random choices; equal seeds give equal results."
    standing["coder"] = "Belongs to the object that this describes."
    standing["domain"] = "Linear light or display values."
    standing["storage"] = "How coefficients are stored."
    standing["step"] = "Steps of the quantiser."
    standing["compression"] = "Of the file, without loss."
    standing["geometry"] = "Where the pixels lie in the world."
    standing["projection"] = "Planar, slab or a panorama."
    standing["transfer"] = "What code values mean."
    standing["filter"] = "How the picture is looked at between its texels."
    standing["interpolation"] = "How cameras become a ray."
    standing["direction"] = "Unit vector."
    standing["position"] = "World units."
    standing["normal"] = "Unit vector."
    standing["eye"] = "World units."
    standing["rgb"] = "Red, green, blue, linear light."
    standing["kind"] = "Which of them it is."
    standing["disc"] = standing["stroke"] = "An array of as many as the ranges say."
    standing["weight"] = "Weights; they sum to 1."
    standing["camera_z"] = standing["st_min"] = standing["st_max"] = "World units."
    standing["pose"] = "The frame of the slab in the world."
    standing["has_depth"] = standing["has_mask"] = "Whether the views have it."
    standing["hemispherical"] = "No light comes from below the horizon."
    standing["pole_y"] = "Theta is measured from +y, not from +z."
    standing["light_count"] = standing["eye_count"] = standing["photograph_count"] = "How many there are."
    standing["ball_photograph_count"] = standing["flat_count"] = standing["vertex_count"] = "How many there are."
    standing["triangle_count"] = standing["vertices"] = standing["dims"] = "How many there are."
    standing["file_bytes"] = "Size of the file."
}
function trailing(line,   i) { # column of a comment behind code, 0: none
    if (line ~ /^[ \t]*\/\//) return 0
    i = match(line, /[ \t]\/\/ /)
    return i && substr(line, 1, i) ~ /[^ \t]/ ? i + 1 : 0
}
{
    line = $0
    sub(/\r$/, "", line)
}
# the paragraph at the head of a file, up to the first line that is no comment
!headed {
    if (line ~ /^\/\//) {
        sub(/^\/\/ ?/, "", line)
        if (NR == 1) {
            print "/// @file"
            sub(/^[a-z_]+\.h - /, "", line)
        }
        print "/// " line
        next
    }
    headed = 1
}
line ~ /^[ \t]*\/\/ ?-----/ { # a line between parts
    print ""
    shared = ""
    next
}
line ~ /^[ \t]*\/\// {
    at = match(line, /\/\//)
    if (column && at == column) {
        sub(/\/\//, "///<", line)
    } else {
        column = 0
        if (!above) shared = ""
        above = 1
        sub(/\/\//, "///", line)
        shared = shared line "\n"
    }
    print line
    next
}
{
    column = trailing(line)
    if (line ~ /^[ \t]*$/) {
        shared = ""
        above = 0
    }
    code = column ? substr(line, 1, column - 1) : line
    comment = column ? substr(line, column + 2) : ""
    if (code ~ /^ +[a-z][a-z_0-9 ]* [*]?[a-z_0-9]+(\[[^]]*\])*(, [*]?[a-z_0-9]+(\[[^]]*\])*)*; *$/ && code !~ /^ +return /) {
        # type a, b;  ->  type a; type b;
        names = code
        sub(/; *$/, "", names)
        match(names, /^ +[a-z][a-z_0-9 ]* /)
        type = substr(names, 1, RLENGTH)
        n = split(substr(names, RLENGTH + 1), name, ", ")
        for (i = 1; i <= n; i++) {
            if (above && i > 1) printf "%s", shared
            bare = name[i]
            sub(/\[.*/, "", bare)
            gsub(/[^a-z_0-9]/, "", bare)
            own = column ? comment : above ? "" : standing[bare]
            print type name[i] ";" (own != "" ? "  ///< " own : "")
        }
        above = 0
        next
    }
    if (!above && code ~ /^struct relume_[a-z_]*_params [{]/)
        print "/// Parameters: zero in a field means its default, NULL for all of them."
    if (!above && code ~ /^RELUME_API void relume_[a-z_]*_destroy\(/)
        print "/// Frees it and leaves NULL, or an empty struct, in its place; fine for both."
    if (!above && !column && match(code, /^#define relume_[a-z_]*_params\(/))
        print "/// Fills a struct of the same name in place: (.field = value, ...), the others are zero."
    above = 0
    print column ? code "///<" comment : line
}
