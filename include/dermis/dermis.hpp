/// All of dermis but the EXR files.
#pragma once

#include "dermis/device.hpp"
#include "dermis/error.hpp"
#include "dermis/event.hpp"
#include "dermis/frame.hpp"
#include "dermis/lights.hpp"
#include "dermis/plan.hpp"
#include "dermis/profile.hpp"
#include "dermis/profile_text.hpp"
#include "dermis/settings.hpp"
#include "dermis/shading.hpp"
#include "dermis/taps.hpp"
#include "dermis/texture.hpp"
#include "dermis/translucency.hpp"
#include "dermis/version.hpp"
