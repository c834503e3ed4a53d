# Writes the points of docs/tube/robot7_rail.toml as a program: awk -f scenarios/47_robot7_rail/rail.awk
# X(s) = offset + slope z + sum amplitude sin(2 pi turns z + phase) + height tanh((s - at)/width), z = s/length; joints in rad.
# A line a node, each with the time that it takes at the highest speed of the fibre there (G93).
function tanh(x,  e) { e = exp(2 * x); return (e - 1) / (e + 1) }
function value(c, s,  z, x) {
  z = s / length_mm
  x = offset[c] + slope[c] * z + b1[c] * sin(2 * pi * n1[c] * z + f1[c]) + b2[c] * sin(2 * pi * n2[c] * z + f2[c])
  if (height[c] != 0) x += height[c] * tanh((s - at[c]) / width[c])
  return letter[c] == "X" ? x : x * 180 / pi
}
function axis(name, text,  v) {
  letter[++axes] = name
  split(text, v, " ")
  offset[axes] = v[1]; slope[axes] = v[2]
  b1[axes] = v[3]; n1[axes] = v[4]; f1[axes] = v[5]
  b2[axes] = v[6]; n2[axes] = v[7]; f2[axes] = v[8]
  height[axes] = v[9]; at[axes] = v[10]; width[axes] = v[11]
}
function place(s,  c, text) {
  for (c = 1; c <= axes; c++) text = text sprintf(" %s%.7f", letter[c], value(c, s))
  return text
}
BEGIN {
  pi = atan2(0, -1)
  length_mm = 3000; nodes = 941
  axis("A", "0.20 0.30 0.020 1.0 0.40 0 0 0 0 0 1")
  axis("B", "-0.35 -0.25 0.015 1.5 2.10 0 0 0 0 0 1")
  axis("C", "0.80 0.20 0 0 0 0 0 0 0 0 1")
  axis("U", "0 0.20 0.010 1.0 1.70 0 0 0 0 0 1")
  axis("V", "0.30 -0.20 0 0 0 0 0 0 0 0 1")
  axis("W", "-0.10 0.35 0.010 1.0 2.90 0 0 0 0 0 1")
  axis("X", "200 3300 700 1.0 3.141592653589793 0 0 0 0 0 1")
  print "(written by: awk -f scenarios/47_robot7_rail/rail.awk)"
  print "G21 G90"
  print "G0" place(0)
  print "G4 P0.1"
  print "G93 (each move in 1/F minutes: the fibre at 750 mm/s)"
  ds = length_mm / (nodes - 1)
  for (i = 1; i < nodes; i++) {
    fast = 750
    # technology point at 2800 mm
    if (ds * (i - 1) <= 2800 && 2800 < ds * i) fast = 200
    print "G1" place(ds * i) sprintf(" F%.6f", 60 * fast / ds)
  }
  print "G94"
  print "M2"
}
