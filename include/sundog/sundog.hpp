// The whole C++ interface of sundog (docs/guide/library.md introduces it); <sundog/sundog.h> is the C
// interface.
#pragma once
#include <sundog/devices.h>
#include <sundog/error.h>
#include <sundog/image.h>
#include <sundog/render.h>
#include <sundog/scene.h>
#include <sundog/session.h>
#include <sundog/version.h>
