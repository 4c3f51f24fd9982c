/// What the channels of a picture are for, in the caller's words.
#pragma once

#include <string>
#include <vector>

#include "arguments/picture_arguments.hpp"
#include "dermis/exr.hpp"

namespace dermis::program {

/// The views to work on: the one that was asked for, else each that the picture has; one without a name if it has none.
/// Throws Error(role_missing) if there is no such view.
std::vector<std::string> views_of(const exr::Picture& picture, const PictureArguments& arguments);

/// Finds the roles in a view (the default one if that is empty). Files that --role names are joined to the picture,
/// which is that of `path`. Throws as exr::find_roles, exr::Picture::join, and Error(usage) for a preset that there is
/// not, or a number of a frame that `path` has not.
exr::Roles roles_of(exr::Picture& picture, const std::string& path, const PictureArguments& arguments,
                    const std::string& view = {});

/// A text with the number of a frame, the last one in the name of a file, in the place of "####" or "%04d". Throws
/// Error(usage) that names `argument` if the file has no number where the text wants one.
std::string with_frame_number(std::string_view argument, const std::string& text, const std::string& path);

}  // namespace dermis::program
