// All of sundog's C++ interface. docs/library.md introduces it; <sundog/sundog.h> is the one for C.
#pragma once
#include <sundog/devices.h>
#include <sundog/error.h>
#include <sundog/image.h>
#include <sundog/render.h>
#include <sundog/scene.h>
#include <sundog/session.h>
#include <sundog/version.h>
