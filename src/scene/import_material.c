/* Materials of other programs as those of the classic shading. The rules, with their reasons, are
 * in docs/import.md. */
#include "scene/import_internal.h"

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/exact.h"
#include "base/memory.h"

#define SHININESS_MAX 1e6

static double clamp(double value, double low, double high)
{
    return value >= low ? fmin(value, high) : low; /* NaN: low */
}

static lr_color grey(double value)
{
    return (lr_color){value, value, value};
}

static double greatest(lr_color c)
{
    return fmax(c.x, fmax(c.y, c.z));
}

static lr_color mix(lr_color a, lr_color b, double share_of_b)
{
    return lr_vec3_add(lr_vec3_scale(a, 1 - share_of_b), lr_vec3_scale(b, share_of_b));
}

static void set_color(lr_material *material, lr_color color)
{
    material->color.colors[0] = material->color.colors[1] = color;
}

/* ---- glTF: metal and roughness ------------------------------------------------------------- */

/* object[key] as a colour within 0..limit. */
static lr_color gltf_color(const json_t *object, const char *key, double fallback, double limit)
{
    const json_t *list = lr_gltf_member(object, key);
    double c[3] = {fallback, fallback, fallback};
    for (size_t i = 0; json_is_array(list) && i < 3 && i < json_array_size(list); i++)
        if (json_is_number(json_array_get(list, i)))
            c[i] = clamp(json_number_value(json_array_get(list, i)), 0, limit);
    return (lr_color){c[0], c[1], c[2]};
}

/* What goes through: thin without KHR_materials_volume, which bends nothing. */
static void set_transmission(const json_t *json, lr_color base, double share, lr_material *material)
{
    const json_t *volume = lr_gltf_extension(json, "KHR_materials_volume");
    bool thick = lr_gltf_number(volume, "thicknessFactor", 0) > 0;
    double distance = lr_gltf_number(volume, "attenuationDistance", 0);
    lr_color left = gltf_color(volume, "attenuationColor", 1, 1);
    material->transmit = lr_vec3_scale(base, share);
    material->fresnel = thick;
    /* From inside, a one-sided surface would not be there. */
    material->one_sided = false;
    if (!thick) {
        material->ior = 1;
        return;
    }
    if (distance > 0 && distance <= LR_COORDINATE_MAX) {
        double *out = &material->absorption.x;
        const double *c = &left.x;
        for (int i = 0; i < 3; i++) /* exp(-absorption distance) = c, with ln 2 = 0.693... */
            out[i] =
                clamp(-lr_log2(fmax(c[i], 1e-6)) * 0.69314718055994531 / distance, 0, LR_COLOR_MAX);
    }
}

/* What only paths see. */
static void set_layers(const json_t *json, lr_material *material)
{
    const json_t *coat = lr_gltf_extension(json, "KHR_materials_clearcoat");
    const json_t *sheen = lr_gltf_extension(json, "KHR_materials_sheen");
    material->clearcoat = clamp(lr_gltf_number(coat, "clearcoatFactor", 0), 0, 1);
    material->clearcoat_roughness =
        clamp(lr_gltf_number(coat, "clearcoatRoughnessFactor", 0), 0, 1);
    material->sheen = gltf_color(sheen, "sheenColorFactor", 0, 1);
    material->sheen_roughness = clamp(lr_gltf_number(sheen, "sheenRoughnessFactor", 0), 0, 1);
}

/* Colour, highlight, mirror, matt share and what goes through. */
static void set_surface(const json_t *json, bool as_metal, lr_material *material)
{
    const json_t *pbr = lr_gltf_member(json, "pbrMetallicRoughness");
    const json_t *thin = lr_gltf_extension(json, "KHR_materials_transmission");
    const json_t *bending = lr_gltf_extension(json, "KHR_materials_ior");
    lr_color base = gltf_color(pbr, "baseColorFactor", 1, 1);
    double metallic = as_metal ? clamp(lr_gltf_number(pbr, "metallicFactor", 1), 0, 1) : 0;
    double roughness = clamp(lr_gltf_number(pbr, "roughnessFactor", 1), 0, 1);
    double transmission = clamp(lr_gltf_number(thin, "transmissionFactor", 0), 0, 1);
    double ior = lr_gltf_number(bending, "ior", 1.5);
    material->ior = ior >= 1 && ior <= 100 ? ior : 1.5;

    /* Mirrors fade out at a roughness of 0.5; what a rough metal would spread is shown as matt. */
    double mirror = fmax(0, 1 - 2 * roughness);
    double facing = (material->ior - 1) / (material->ior + 1);
    lr_color f0 = mix(grey(facing * facing), base, metallic);
    double width = roughness * roughness;
    material->shininess = clamp(2 / fmax(width * width, 1e-12) - 2, 0, SHININESS_MAX);
    /* (n + 8) / 8 keeps the light of a Blinn-Phong highlight the same for all widths; held at 1.
     * The widest would be a second matt share. */
    double strength = fmin((material->shininess + 8) / 8, 1 / fmax(greatest(f0), 1e-6));
    material->specular = lr_vec3_scale(f0, strength * (1 - roughness));
    material->reflect = lr_vec3_scale(f0, mirror);
    set_color(material, base);
    material->diffuse = grey((1 - metallic) * (1 - transmission) + metallic * (1 - mirror));
    if (transmission * (1 - metallic) > 0)
        set_transmission(json, base, transmission * (1 - metallic), material);
    /* What has no inside has no index of refraction here: paths see it as the classic shading does.
     */
    if (transmission > 0 && material->ior == 1)
        return;
    material->model = LR_MODEL_PBR;
    material->roughness = roughness;
    material->metallic = metallic;
    material->transmission = transmission;
    set_layers(json, material);
}

/* Sets what alphaMode says; true when that is only nearly what it means. */
static bool set_alpha(const json_t *json, lr_material *material)
{
    const json_t *pbr = lr_gltf_member(json, "pbrMetallicRoughness");
    const json_t *item = json_array_get(lr_gltf_member(pbr, "baseColorFactor"), 3);
    const char *mode = json_string_value(lr_gltf_member(json, "alphaMode"));
    if (mode && strcmp(mode, "MASK") == 0)
        material->alpha_cutoff = clamp(lr_gltf_number(json, "alphaCutoff", 0.5), 0, 1);
    if (!mode || strcmp(mode, "BLEND") != 0)
        return false;
    double alpha = json_is_number(item) ? clamp(json_number_value(item), 0, 1) : 1;
    bool through = greatest(material->transmit) > 0;
    if (alpha < 1)
        material->model = LR_MODEL_CLASSIC;
    material->alpha_cutoff = lr_gltf_member(pbr, "baseColorTexture") ? 0.5 : 0;
    material->diffuse = lr_vec3_scale(material->diffuse, alpha);
    material->transmit = lr_vec3_add(lr_vec3_scale(material->transmit, alpha), grey(1 - alpha));
    if (alpha < 1 && !through) {
        material->ior = 1;
        material->one_sided = false;
    }
    return true;
}

static void set_emission(const json_t *json, lr_material *material)
{
    const json_t *strength = lr_gltf_extension(json, "KHR_materials_emissive_strength");
    double light = clamp(lr_gltf_number(strength, "emissiveStrength", 1), 0, LR_COLOR_MAX);
    material->emission = lr_vec3_scale(gltf_color(json, "emissiveFactor", 0, 1), light);
}

/* Without the texture of its light, the surface sends out none: it would be far too much. */
static lr_status emission_map(lr_import *import, const struct aiMaterial *from,
                              lr_material *material)
{
    bool wanted = greatest(material->emission) > 0;
    lr_status status = wanted ? lr_import_map(import, from, aiTextureType_EMISSIVE, "emissive map",
                                              LR_MAP_EMISSION, (lr_map){.given = false}, material)
                              : LR_OK;
    if (!status && wanted && !material->maps[LR_MAP_EMISSION].given)
        material->emission = grey(0);
    return status;
}

static lr_status gltf_maps(lr_import *import, const json_t *json, const struct aiMaterial *from,
                           lr_material *material)
{
    const json_t *pbr = lr_gltf_member(json, "pbrMetallicRoughness");
    const json_t *normal = lr_gltf_member(json, "normalTexture");
    lr_map relief = {.amount = clamp(lr_gltf_number(normal, "scale", 1), -1000, 1000)};
    lr_map roughness = {.channel = LR_CHANNEL_GREEN}, metallic = {.channel = LR_CHANNEL_BLUE};
    lr_status status = LR_OK;
    if (normal)
        status = lr_import_map(import, from, aiTextureType_NORMALS, "normal map", LR_MAP_NORMAL,
                               relief, material);
    if (!status && lr_gltf_member(pbr, "metallicRoughnessTexture") &&
        material->model == LR_MODEL_PBR) {
        status = lr_import_map(import, from, aiTextureType_UNKNOWN, "metallic-roughness map",
                               LR_MAP_ROUGHNESS, roughness, material);
        metallic.texture = material->maps[LR_MAP_ROUGHNESS].texture;
        metallic.given = material->maps[LR_MAP_ROUGHNESS].given;
        material->maps[LR_MAP_METALLIC] = metallic.given ? metallic : (lr_map){.given = false};
        /* Without it nobody knows what is metal: most is not. */
        material->metallic = metallic.given ? material->metallic : 0;
    }
    if (!status && lr_gltf_member(json, "emissiveTexture"))
        status = emission_map(import, from, material);
    return status;
}

static lr_status gltf_material(lr_import *import, const json_t *json, const struct aiMaterial *from,
                               lr_material *material)
{
    const json_t *pbr = lr_gltf_member(json, "pbrMetallicRoughness");
    const json_t *texture = lr_gltf_member(pbr, "baseColorTexture");
    bool mapped = lr_gltf_member(pbr, "metallicRoughnessTexture") != NULL;
    material->one_sided = !json_is_true(lr_gltf_member(json, "doubleSided"));
    set_surface(json, !mapped, material);
    bool blended = set_alpha(json, material);
    set_emission(json, material);
    if (material->model == LR_MODEL_PBR)
        material->metallic = clamp(lr_gltf_number(pbr, "metallicFactor", 1), 0, 1);
    const struct {
        bool applies;
        const char *text;
    } notes[] = {
        {mapped && material->model != LR_MODEL_PBR,
         "metallicRoughnessTexture is not used, the surface is shown as no metal"},
        {lr_gltf_extension(texture, "KHR_texture_transform") != NULL,
         "the shift, turn and scale of its texture are left out"},
        {blended && !texture, "alphaMode BLEND is shown as letting rays through"},
        {blended && texture, "alphaMode BLEND is shown as letting rays through, and nothing is "
                             "where the texture's alpha is below 0.5"},
    };
    lr_status status = LR_OK;
    for (size_t i = 0; !status && i < sizeof notes / sizeof *notes; i++)
        if (notes[i].applies)
            status = lr_import_note(import, "material \"%s\": %s", material->name, notes[i].text);
    return status || !from ? status : gltf_maps(import, json, from, material);
}

/* ---- OBJ and the others -------------------------------------------------------------------- */

bool lr_import_has_numbers(const struct aiMaterial *from, const char *key, unsigned texture_type)
{
    const struct aiMaterialProperty *found;
    return aiGetMaterialProperty(from, key, texture_type, 0, &found) == aiReturn_SUCCESS &&
           found->mType != aiPTI_String;
}

/* The number under the key, of the material or of one of its textures. */
static double number_in(const struct aiMaterial *from, const char *key, unsigned texture_type,
                        double fallback)
{
    ai_real value = 0;
    unsigned count = 1;
    if (!lr_import_has_numbers(from, key, texture_type) ||
        aiGetMaterialFloatArray(from, key, texture_type, 0, &value, &count) != aiReturn_SUCCESS ||
        count < 1)
        return fallback;
    return isfinite(value) ? (double)value : fallback;
}

static double number_of(const struct aiMaterial *from, const char *key, double fallback)
{
    return number_in(from, key, 0, fallback);
}

static lr_color color_of(const struct aiMaterial *from, const char *key, double fallback,
                         double limit)
{
    struct aiColor4D c;
    if (!lr_import_has_numbers(from, key, 0) ||
        aiGetMaterialColor(from, key, 0, 0, &c) != aiReturn_SUCCESS)
        return grey(fallback);
    return (lr_color){clamp((double)c.r, 0, limit), clamp((double)c.g, 0, limit),
                      clamp((double)c.b, 0, limit)};
}

/* The illumination models of the MTL format: 2 and up have highlights; 3, 4, 5, 8 and 9 mirror; 4,
 * 6, 7 and 9 let rays through, which bend; 5 and 7 share by Fresnel's formulas. */
static bool one_of(int model, const char *digits)
{
    return model >= 0 && model <= 9 && strchr(digits, '0' + model) != NULL;
}

/* What MTL calls bump is often a picture of normals: one in colours counts as such. Its heights
 * have no unit; white is a centimetre, times -bm. */
static lr_status mtl_maps(lr_import *import, const struct aiMaterial *from, lr_material *material)
{
    const char *bump = _AI_MATKEY_OBJ_BUMPMULT_BASE;
    double factor = clamp(number_in(from, bump, aiTextureType_HEIGHT, 1), -1000, 1000);
    lr_map normals = {.amount = 1}, heights = {.amount = 0.01 * factor};
    lr_status status = lr_import_map(import, from, aiTextureType_NORMALS, "normal map",
                                     LR_MAP_NORMAL, normals, material);
    if (!status && !material->maps[LR_MAP_NORMAL].given)
        status = lr_import_map(import, from, aiTextureType_HEIGHT, "bump map", LR_MAP_BUMP, heights,
                               material);
    if (!status && material->maps[LR_MAP_BUMP].given &&
        lr_import_is_colored(import, material->maps[LR_MAP_BUMP].texture)) {
        normals.amount = factor;
        material->maps[LR_MAP_BUMP] = (lr_map){.given = false};
        status = lr_import_map(import, from, aiTextureType_HEIGHT, "bump map", LR_MAP_NORMAL,
                               normals, material);
    }
    struct aiString path;
    bool shines = aiGetMaterialString(from, AI_MATKEY_TEXTURE(aiTextureType_EMISSIVE, 0), &path) ==
                  aiReturn_SUCCESS;
    if (status || !shines)
        return status;
    /* Without Ke the picture is the light. */
    if (greatest(material->emission) == 0)
        material->emission = grey(1);
    return emission_map(import, from, material);
}

static lr_status mtl_material(lr_import *import, const struct aiMaterial *from,
                              lr_material *material)
{
    int model = 2;
    unsigned count = 1;
    if (!lr_import_has_numbers(from, "$mat.illum", 0) ||
        aiGetMaterialIntegerArray(from, AI_MATKEY_OBJ_ILLUM, &model, &count) != aiReturn_SUCCESS)
        model = 2;
    lr_color specular = color_of(from, "$clr.specular", 0, 1);
    double opacity = clamp(number_of(from, "$mat.opacity", 1), 0, 1);
    double ior = number_of(from, "$mat.refracti", 1);
    set_color(material, color_of(from, "$clr.diffuse", 0.8, 1));
    material->diffuse = grey(opacity);
    material->emission = color_of(from, "$clr.emissive", 0, LR_COLOR_MAX);
    material->shininess = clamp(number_of(from, "$mat.shininess", 0), 0, SHININESS_MAX);
    if (model >= 2 && material->shininess > 0)
        material->specular = specular;
    if (one_of(model, "34589"))
        material->reflect = specular;
    bool bends = one_of(model, "4679");
    lr_color filter = bends ? color_of(from, "$clr.transparent", 1, 1) : grey(1);
    material->transmit = lr_vec3_scale(filter, 1 - opacity);
    material->ior = bends && ior >= 0.01 && ior <= 100 ? ior : 1;
    material->fresnel = one_of(model, "57");
    return mtl_maps(import, from, material);
}

/* PLY and STL have no materials: the colour of the scene language's default. */
static void plain_material(lr_material *material)
{
    set_color(material, grey(0.8));
    material->diffuse = grey(1);
}

/* ---- Both ---------------------------------------------------------------------------------- */

static lr_status name_material(lr_import *import, const struct aiMaterial *from, uint32_t index,
                               lr_material *material)
{
    struct aiString name = {0};
    char shown[80];
    if (from && aiGetMaterialString(from, AI_MATKEY_NAME, &name) != aiReturn_SUCCESS)
        name.data[0] = 0;
    lr_import_shown(shown, sizeof shown, name.data);
    if (!shown[0])
        snprintf(shown, sizeof shown, "material %u", index);
    material->name = lr_string_copy(shown, strlen(shown));
    return material->name ? LR_OK : lr_import_no_memory(import);
}

lr_status lr_import_material(lr_import *import, uint32_t index, uint32_t *material)
{
    const struct aiScene *scene = import->scene;
    lr_scene *to = import->builder->scene;
    /* One more than assimp's for meshes whose material there is not. */
    uint32_t slot = index < scene->mNumMaterials ? index : scene->mNumMaterials;
    const struct aiMaterial *from = index < scene->mNumMaterials ? scene->mMaterials[index] : NULL;
    *material = import->materials[slot];
    if (*material != LR_NONE)
        return LR_OK;
    if (to->material_count >= LR_MATERIALS_MAX)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: more than %d materials", import->shown,
                       LR_MATERIALS_MAX);
    lr_material *added = lr_scene_add_material(import->builder);
    if (!added)
        return lr_import_no_memory(import);
    *material = import->materials[slot] = to->material_count - 1;
    *added = (lr_material){.color = {.size = 1, .direction = {0, 1, 0}}, .ior = 1.5};
    lr_status status = name_material(import, from, slot, added);
    if (status)
        return status;
    if (import->json)
        status = gltf_material(import, lr_gltf_material(import, slot), from, added);
    else if (from && import->kind == LR_IMPORT_OBJ)
        status = mtl_material(import, from, added);
    else
        plain_material(added);
    added->ambient = added->diffuse;
    if (!status && from)
        status = lr_import_texture(import, from, added);
    return status;
}
