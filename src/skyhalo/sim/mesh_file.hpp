#pragma once

#include <filesystem>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// Which axis of a mesh file points up. The others follow: with y up, the file's -z is the scene's
/// x (forward) and its -x the scene's y; with x up, y stays and -z is forward.
enum class UpAxis { kX, kY, kZ };

/// How a mesh file is meant.
struct MeshFileOptions {
  double unit_m = 1.0;  ///< length of the file's unit, > 0
  UpAxis up = UpAxis::kZ;
};

/// A scene of a mesh file that Assimp can read (OBJ, PLY, glTF, ...), with its colours and its
/// picture textures (beside the file or embedded). Nothing in it moves.
///
/// Throws `Error` (input) naming the file when it is missing, is no mesh, holds no triangle, or a
/// coordinate that is not finite, and naming the texture when that cannot be read.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, const MeshFileOptions& options);

}  // namespace skyhalo
