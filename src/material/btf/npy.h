// npy.h - arrays in NumPy's file format (NEP 1, version 1.0), mapped into memory
//
// The format is a text header of at most 64 KiB and the bare array behind it: any element is found
// by arithmetic, so that a file of many gigabytes is used in place, here and in NumPy.
#ifndef BTF_NPY_H
#define BTF_NPY_H

#include <relume/base.h>

enum npy_kind { NPY_HALF, NPY_FLOAT, NPY_U8, NPY_U16, NPY_U32 };
enum { NPY_DIMS = 5 };

struct npy {
    enum npy_kind kind;
    int dims;
    size_t shape[NPY_DIMS];  // the last one runs fastest
};

size_t npy_item(enum npy_kind kind);
// Bytes of the data; SIZE_MAX when that overflows.
size_t npy_bytes(const struct npy *npy);

// A file read in place.
struct npy_file {
    struct npy npy;
    const void *data;
    void *map;
    size_t map_size;
};
// An input status with a sentence: missing, foreign, another kind of array, not as long as it says.
relume_status npy_open(struct npy_file *file, const char *path, const struct relume_log *log);
void npy_close(struct npy_file *file);

// RELUME_EIO, RELUME_ENOMEM.
relume_status npy_save(const struct npy *npy, const void *data, const char *path,
                       const struct relume_log *log);

#endif
