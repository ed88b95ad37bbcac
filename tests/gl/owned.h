// owned.h - an app that is released where its name ends
#ifndef TESTS_GL_OWNED_H
#define TESTS_GL_OWNED_H

#include "app/app.h"

#define OWNED_APP __attribute__((cleanup(app_release))) struct app

#endif
