// start.c - the program relume
#include "start.h"

int main(int argc, char **argv)
{
    return tool_exit(tool_run(argc, argv, NULL, 0));
}
