// scenes/showcase.yaml for POV-Ray: the same objects, materials, lights and ray depth. Its world is
// left-handed: `right` points along -x. Its light fades as 2 / (1 + (d / fade_distance)^2): with a
// tiny fade_distance 1 / d^2, and the colour makes up for the factor. adc_bailout stands for
// min_weight. fade_power 1001 leaves exp(-(1 - fade_color) distance / fade_distance) of the light.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 7 adc_bailout 0.004 ambient_light rgb <0.06, 0.07, 0.1> }
#declare Fade = 0.001;
#macro Lamp(P, C, I) light_source { P rgb C * I / (2 * Fade * Fade) fade_distance Fade fade_power 2 } #end
camera {
  location <0.4, 2.1, 8.6> right -4/3*x up y
  angle degrees(2 * atan2(4/3 * tan(radians(16.5)), 1)) look_at <0, 0.92, 0>
}
background { rgb 0 }
sky_sphere { pigment { function { (y + 1) / 2 } color_map { [0 rgb <1.75, 0.92, 0.45>] [1 rgb <0, 0.1, 0.42>] } } }
Lamp(<5.5, 7, 5>, <1, 0.86, 0.66>, 62)
Lamp(<-6, 4.5, 3.5>, <0.35, 0.55, 1>, 30)
Lamp(<0.5, 3.2, -5>, <1, 0.3, 0.55>, 16)
#macro Matt(D, S, N) finish { ambient D diffuse D specular S roughness 1 / N } #end
#declare Glass = material { texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 specular 0.6 roughness 1/600 reflection { 0, 1 fresnel on } conserve_energy } } interior { ior 1.5 } }
#macro Tinted(A, I) material { texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 specular 0.5 roughness 1/400 reflection { 0, 1 fresnel on } conserve_energy } } interior { ior I fade_distance 1/4 fade_power 1001 fade_color 1 - A/4 } } #end
#macro Lacquer(C, D, R, S, N) texture { pigment { rgb C } finish { ambient D diffuse D specular S roughness 1 / N reflection { 0, R fresnel on } } } interior { ior 1.6 } #end
plane { y, 0 texture { pigment { checker rgb <0.68, 0.62, 0.54> rgb <0.05, 0.07, 0.12> translate 0.5*y } finish { ambient 0.9 diffuse 0.9 reflection { 0, 0.5 fresnel on } } } interior { ior 1.6 } }
sphere { <0.25, 1.05, 0.7>, 1.05 material { Glass } }
sphere { <0.25, 1.05, 0.7>, 0.42 texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 } } interior { ior 1 } }
sphere { <-2.05, 1.4, -1.7>, 1.4 pigment { rgb <0.9, 0.6, 0.2> } finish { ambient 0.18 diffuse 0.18 specular 0.8 roughness 1/200 reflection { rgb <0.95, 0.7, 0.3> } } }
sphere { <2.5, 1.1, -1.5>, 1.1 pigment { rgb <0.8, 0.85, 0.9> } finish { ambient 0.06 diffuse 0.06 specular 0.7 roughness 1/300 reflection { rgb <0.88, 0.9, 0.93> } } }
box { <-0.45, 0, -0.45>, <0.45, 0.9, 0.45> pigment { wood color_map { [0.5 rgb <0.5, 0.28, 0.12>] [0.5 rgb <0.34, 0.17, 0.07>] } rotate 90*x scale 0.1 } Matt(0.9, 0.15, 30) rotate 28*y translate <0.5, 0, -3.4> }
sphere { <0.5, 1.4, -3.4>, 0.5 Lacquer(<0.75, 0.05, 0.07>, 0.9, 1, 0.6, 150) }
sphere { <-1.15, 0.42, 1.9>, 0.42 Lacquer(<0.75, 0.05, 0.07>, 0.9, 1, 0.6, 150) }
sphere { <1.72, 0.5, 1.75>, 0.5 Tinted(<0.15, 0.9, 3.2>, 1.45) }
box { <-0.32, 0.001, -0.32>, <0.32, 0.64, 0.32> Tinted(<2.4, 0.3, 1.1>, 1.5) rotate 35*y translate <-2.15, 0, 1.05> }
cone { <2.55, 0, 0.75>, 0.38, <2.55, 1, 0.75>, 0 Lacquer(<0.03, 0.42, 0.45>, 0.9, 1, 0.6, 150) }
cylinder { <0, 0, 0>, <0, 1.25, 0>, 0.16 pigment { gradient <0.4, 1, 0> color_map { [0.5 rgb <0.9, 0.86, 0.8>] [0.5 rgb <0.75, 0.08, 0.12>] } scale 0.24 } Matt(0.9, 0.4, 80) translate <-1.05, 0, 0.1> }
sphere { <-1.05, 1.45, 0.1>, 0.22 pigment { rgb <0.8, 0.85, 0.9> } finish { ambient 0.06 diffuse 0.06 specular 0.7 roughness 1/300 reflection { rgb <0.88, 0.9, 0.93> } } }
sphere { <0.55, 0.2, 2.6>, 0.2 Lacquer(<0.03, 0.42, 0.45>, 0.9, 1, 0.6, 150) }
sphere { <-0.25, 0.16, 2.75>, 0.16 pigment { rgb <0.9, 0.6, 0.2> } finish { ambient 0.18 diffuse 0.18 specular 0.8 roughness 1/200 reflection { rgb <0.95, 0.7, 0.3> } } }
sphere { <-0.62, 0.12, 2.95>, 0.12 pigment { rgb <0.85, 0.8, 0.68> } Matt(0.9, 0.2, 40) }
cylinder { <1.05, 0.1, 2.65>, <1.4, 0.1, 2.95>, 0.1 pigment { rgb <0.85, 0.8, 0.68> } Matt(0.9, 0.2, 40) }
