# Draws docs/images/intensity.svg from intensity.dat (measure_intensity).
set terminal svg size 860,300 font "sans,12" background "white"
set output "docs/images/intensity.svg"
set multiplot layout 1,3
set xlabel "hidden patches"
set xrange [0:50]
set key top left
do for [i=0:2] {
  set title word("0/100 25/75 50/50", i + 1)
  set ylabel (i == 0 ? "variance of the error" : "")
  plot "intensity.dat" index i using 2:3 with lines linewidth 2 linecolor rgb "#d55e00" title "red", \
       "" index i using 2:4 with lines linewidth 2 linecolor rgb "#009e73" title "green", \
       "" index i using 2:5 with lines linewidth 2 linecolor rgb "#0072b2" title "blue"
}
unset multiplot
