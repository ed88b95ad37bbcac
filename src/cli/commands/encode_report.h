// encode_report.h - sentences about a capture that has been encoded
#ifndef ENCODE_REPORT_H
#define ENCODE_REPORT_H

#include "cli/cli.h"

// A capture and the file that was made of it.
struct encoded_file {
    const char *input, *output;
    const relume_capture *capture;
    const struct relume_encode_capture_params *params;
    const struct relume_encode_result *result;
};
// Sends quality, size and remarks to the log. The state of learning goes to standard output, where
// scripts wait for it.
void say_encoded(const struct args *args, const struct encoded_file *file);
// The same of a relume file that was coded again, which had `bytes`; there is no capture.
void say_coded_again(const struct args *args, const struct encoded_file *file, double bytes);

#endif
