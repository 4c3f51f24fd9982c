/// What the channels of a picture are for, in the caller's words.
#pragma once

#include <string>
#include <vector>

#include "arguments/picture_arguments.hpp"
#include "dermis/exr.hpp"
#include "files/frame_names.hpp"

namespace dermis::program {

/// The views to work on: the one that was asked for, else each that the picture has; one without a name if it has none.
/// Throws Error(role_missing) if there is no such view.
std::vector<std::string> views_of(const exr::Picture& picture, const PictureArguments& arguments);

/// --role, in whose files the number of a frame stands. Throws Error(usage) if there is a place for a number and
/// `frame` has none.
std::vector<std::string> role_texts(const PictureArguments& arguments, const FrameFile& frame);

/// Finds the roles in a view (the default one if that is empty). Files that --role names are joined to the picture,
/// which is that of `frame`. Throws as exr::find_roles, exr::Picture::join, role_texts, and Error(usage) for a preset
/// that there is not.
exr::Roles roles_of(exr::Picture& picture, const FrameFile& frame, const PictureArguments& arguments,
                    const std::string& view = {});

}  // namespace dermis::program
