// judge.yaml for POV-Ray. Its world is left-handed: `right` points along -x to match ours. Light
// fades as 2 / (1 + (d / fade_distance)^2): with a tiny fade_distance that is 1 / d^2 times
// 2 fade_distance^2, which the colour makes up for.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 6 adc_bailout 0 ambient_light rgb 1 }
#declare Fade = 0.001;
background { rgb <0.2, 0.3, 0.5> }
camera {
  location <0, 2.2, 7>
  right -4/3*x
  up y
  angle degrees(2 * atan2(4/3 * tan(radians(20)), 1))
  look_at <0, 0.8, 0>
}
light_source { <4, 6, 4> rgb 50 / (2 * Fade * Fade) fade_distance Fade fade_power 2 }
plane { y, 0
  pigment { checker rgb <0.8, 0.8, 0.7> rgb <0.2, 0.3, 0.25> translate <0, 0.5, 0> }
  finish { ambient 0.05 diffuse 0.9 } }
sphere { <-1.6, 0.9, 0.4>, 0.9
  pigment { rgb <0.8, 0.15, 0.1> } finish { ambient 0.05 diffuse 0.8 } }
sphere { <1.5, 0.7, 1.2>, 0.7
  pigment { rgb <0.1, 0.2, 0.8> } finish { ambient 0.05 diffuse 0.8 } }
sphere { <0.5, 1.3, -1.6>, 1.3
  pigment { rgb 0.9 } finish { ambient 0 diffuse 0.1 reflection { 0.8 } } }
