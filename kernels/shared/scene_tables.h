// The tables of a compiled scene. This list generates the compiled scene's members, their upload, size and
// hash, the kernels' parameters and the struct Scene. A new table is one line here. The three tables of
// photon maps are empty in a compiled scene: each device fills its own.
//   TABLE(element on the device, element on the host, name, name in messages)
// Only `nodes` has two element types: Bvh8Nodes are uploaded unchanged, or as CompactNodes for devices with
// one ray per lane.
#pragma once
#include "shared/bvh.h"
#include "shared/environment.h"
#include "shared/layers.h"
#include "shared/photons.h"
#include "shared/scene.h"
#include "shared/sdf.h"
#include "shared/spectra.h"
#include "shared/textures.h"

#define SCENE_TABLES(TABLE)                                              \
  TABLE(u32, Bvh8Node, nodes, "BVH nodes")                               \
  TABLE(TriangleBlock, TriangleBlock, blocks, "triangle blocks")         \
  TABLE(Instance, Instance, instances, "instances")                      \
  TABLE(float4, float4, moves, "moves of instances")                     \
  TABLE(Turn, Turn, turns, "turns of instances")                         \
  TABLE(ProfileArc, ProfileArc, profiles, "arcs of profiles")            \
  TABLE(TriangleShading, TriangleShading, triangles, "triangles")        \
  TABLE(Vertex, Vertex, vertices, "vertices")                            \
  TABLE(Material, Material, materials, "materials")                      \
  TABLE(Medium, Medium, media, "media")                                  \
  TABLE(Light, Light, lights, "lights")                                  \
  TABLE(LightRay, LightRay, light_rays, "rays to lights")                \
  TABLE(LightNode, LightNode, light_nodes, "nodes over lights")          \
  TABLE(u32, u32, light_leaves, "leaves of lights")                      \
  TABLE(float, float, lobe_energy, "energy of lobes")                    \
  TABLE(Layers, Layers, layers, "layered materials")                     \
  TABLE(float, float, layer_rows, "light left by layers")                \
  TABLE(float, float, spectra, "spectra")                                \
  TABLE(float4, float4, guides, "guides of paths")                       \
  TABLE(PhotonTarget, PhotonTarget, photon_targets, "photon targets")    \
  TABLE(float, float, photon_lights, "shares of photons")                \
  TABLE(PhotonMap, PhotonMap, photon_maps, "maps of photons")            \
  TABLE(u32, u32, photon_cells, "cells of photons")                      \
  TABLE(float4, float4, photons, "photons")                              \
  TABLE(Environment, Environment, environments, "environments")          \
  TABLE(float4, float4, environment, "environment's pixels")             \
  TABLE(float, float, environment_shares, "environment's shares")        \
  TABLE(u32, u32, environment_cutpoints, "environment's cutpoints")      \
  TABLE(SdfField, SdfField, sdf_fields, "fields")                        \
  TABLE(float, float, sdf_parameters, "field parameters")                \
  TABLE(float, float, filter, "filter")                                  \
  TABLE(MaterialMaps, MaterialMaps, material_maps, "textured materials") \
  TABLE(TextureNode, TextureNode, texture_nodes, "textures")             \
  TABLE(float, float, texture_values, "values of textures")              \
  TABLE(TexelLevel, TexelLevel, texel_levels, "levels of images")        \
  TABLE(u32, u32, texels0, "images")                                     \
  TABLE(u32, u32, texels1, "images")                                     \
  TABLE(u32, u32, texels2, "images")                                     \
  TABLE(u32, u32, texels3, "images")                                     \
  TABLE(float, float, extra_uvs, "further texture coordinates")          \
  TABLE(float, float, vertex_alphas, "alpha of vertices")                \
  TABLE(u32, u32, tangents, "tangents")
