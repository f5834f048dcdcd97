# Draws docs/images/camera_path.svg from path.dat (measure_camera_path).
set terminal svg size 760,320 font "sans,12" background "white"
set output "docs/images/camera_path.svg"
set xlabel "frame"
set ylabel "wrong pixels, %"
set logscale y
set xrange [0:119]
set yrange [0.001:300]
set format y "%g"
set key outside right top
set style fill solid 0.2 noborder
set boxwidth 1
shown(share) = share > 0.00001 ? 100 * share : 0.001  # none is drawn at the lower edge
plot "path.dat" using 1:($5 == 1 ? 300 : 1/0) with boxes linecolor rgb "gray40" title "eye in the shadow", \
     "" using 1:(shown($2)) with lines linewidth 3 linecolor rgb "#d55e00" title "z-pass", \
     "" using 1:(shown($3)) with lines linewidth 2 linecolor rgb "#0072b2" title "z-fail", \
     "" using 1:(shown($4)) with lines dashtype 2 linewidth 1 linecolor rgb "black" title "automatic"
