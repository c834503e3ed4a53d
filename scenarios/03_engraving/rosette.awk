# Writes the engraving's program: rings r(t) = R + h cos(n t), cut in short lines, with a depth that swings with t.
#   awk -f scenarios/03_engraving/rosette.awk > scenarios/03_engraving/program.ngc
BEGIN {
  pi = 3.14159265358979
  print "(written by: awk -f scenarios/03_engraving/rosette.awk)"
  print "G21 G90 G94 G17 G40 G49 G61"
  print "S18000 M3"
  print "G0 X50 Y50 Z5"
  rings = 6
  for (k = 0; k < rings; k++) {
    radius = 5 + 2.5 * k; height = 0.25 * radius; petals = 5 + 2 * (k % 3)
    # about 0.3 mm a line
    n = int(2 * pi * radius * 1.4 / 0.3)
    for (i = 0; i <= n; i++) {
      t = 2 * pi * i / n
      r = radius + height * cos(petals * t)
      x = 50 + r * cos(t); y = 50 + r * sin(t); z = -0.3 - 0.2 * cos(2 * petals * t)
      if (i == 0) {
        printf "(ring %d)\nG0 X%.3f Y%.3f\nG0 Z1\nG1 Z%.3f F300\n", k + 1, x, y, z
        printf "F1500\n"
      } else printf "G1 X%.3f Y%.3f Z%.3f\n", x, y, z
    }
    print "G0 Z1"
  }
  print "G0 Z5"
  print "M5"
  print "M30"
}
