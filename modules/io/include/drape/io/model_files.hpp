// Textured models: what a user opens, mails and publishes.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "drape/geometry/textured_mesh.hpp"

namespace drape::io {

struct GlbOptions {
  bool unlit = false;          // KHR_materials_unlit
  bool jpeg_textures = false;  // PNG otherwise
  int jpeg_quality = 92;
};

/// glTF 2.0 binary (Khronos specification; its pictures have 8 bits a channel). Vertices are written as
/// (transform * vertex) in float32; the transform is to give metres, +Y up, about a local origin.
/// `origin_in_extras` (metres, +Y up) is kept in the scene's extras, so that origin + position is the true
/// place. Base colours are 8-bit sRGB, metallic 0; vertex colours, where a material has no image, are
/// linearised as the format asks. UV origin top left, as inside drape. One primitive per material that has
/// faces; vertices are repeated only where corners differ in (u, v); normals are the mesh's, or computed;
/// normal maps come with tangents, and not in an unlit file, where no viewer looks at them. Error{input} for
/// a model without faces or with numbers out of range; Error{io} if it cannot be written or takes more than 4
/// GiB.
void write_glb(const std::filesystem::path& file, const TexturedMesh& model, const Eigen::Affine3d& transform,
               const Eigen::Vector3d& origin_in_extras, const GlbOptions& options = {});

/// Base name of a material's picture as files have it: its own name and .png, or .tif where the picture has
/// 16 bits a channel; empty for a flat material.
[[nodiscard]] std::string picture_name(const Material& material);
/// PNG of 8 bits or TIFF of 16, as picture_name says. Error{io}.
void write_picture(const std::filesystem::path& file, const Material& material);

/// OBJ with MTL and pictures beside it (<stem>.mtl, <stem>_<picture_name>; blanks of the stem become _,
/// as the format separates names by them), doubles, v flipped to the format's bottom-left origin. Vertex
/// colours (three numbers after x y z) where a flat material needs them. Returns every file written, the OBJ
/// first; it is written last. Errors as write_glb.
std::vector<std::filesystem::path> write_obj(const std::filesystem::path& file, const TexturedMesh& model);

/// Binary PLY with per-face `texcoord` (bottom-left origin), `texnumber` and `comment TextureFile`; vertex
/// colours where a flat material needs them. `picture_files[i]`: base name
/// of material i's picture (relative, without ..), empty for a flat one; the pictures are the caller's to
/// write.
void write_textured_ply(const std::filesystem::path& file, const TexturedMesh& model,
                        const std::vector<std::string>& picture_files);
/// Reads what write_textured_ply wrote (and the like of other programs), pictures included, from
/// `picture_folder`, or the folder of the PLY if that is empty; those of 16 bits are kept so. All but v reads
/// back to the same bits; v to 2^-24. Error{input} as read_mesh; a picture that is missing or lies outside of
/// the folder is one.
[[nodiscard]] TexturedMesh read_textured_ply(const std::filesystem::path& file,
                                             const std::filesystem::path& picture_folder);

/// The mesh with a colour per vertex: the mean, in linear light, of what the faces round it show there.
[[nodiscard]] TriangleMesh with_vertex_colors(const TexturedMesh& model);

}  // namespace drape::io
