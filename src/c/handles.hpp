// The handles of dermis.h.
#pragma once

#include <vector>

#include "dermis/dermis.h"
#include "dermis/dermis.hpp"

struct dermis_device {
  dermis::Device device;
};

struct dermis_profile {
  dermis::Profile profile;
};

struct dermis_settings {
  std::vector<dermis::Material> materials;
  dermis::Options options;
};

/// A frame, or a view of one.
struct dermis_frame {
  dermis::Frame frame;     ///< `views` of it is not kept
  dermis::Image position;  ///< of a view
  std::vector<dermis::View> views;

  dermis::Frame with_views() const {
    dermis::Frame all = frame;
    all.views = views;
    return all;
  }
};

struct dermis_plan {
  dermis::Plan plan;
};

struct dermis_stats {
  dermis::Stats stats;
};
