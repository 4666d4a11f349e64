# Sourced by scripts of this folder: where scenes are looked at and what they are lit by, where their files don't say.

# A scene's views, a line each: arguments of the command.
views_of() {
    case $1 in # of the scenes' suggested views (VIEWS.txt); others by their cameras
        modern_hall) echo "--eye=5.59993,1.5,3.76821 --target=4.69671,1.50938,3.34018 --fov=75
--eye=-5.01302,1.5,-1.9475 --target=-4.05493,1.53437,-1.68494 --fov=75" ;;
        zdm2) echo "--eye=-31.6977,11.2,3.78408 --target=-30.7396,11.2344,4.04664 --fov=75
--eye=-25.8236,6.66473,7.10483 --target=-24.8655,6.69911,7.36739 --fov=75
--eye=15.9793,19.2,-30.391 --target=15.0936,19.2281,-29.9365 --fov=75" ;;
        san_miguel) echo "--eye=-13.714,1.57212,-9.35007 --target=-13.3374,1.58774,-8.42514 --fov=75
--eye=2.98777,1.65016,-3.56943 --target=3.94333,1.65329,-3.86406 --fov=75
--eye=-14.0275,1.28214,-25.5574 --target=-13.0694,1.31652,-25.2948 --fov=75" ;; # first its court
        Sponza) echo "--camera=0
--eye=-4.65801,5.5814,-3.21241 --target=-3.69992,5.61578,-2.94986 --fov=75
--eye=-8.68819,22.7979,3.48218 --target=-7.73264,22.801,3.18755 --fov=75" ;; # not "indoor": a sealed passage, black
        veach_ajar) echo "--camera=0
--eye=-1.46223,1.5,-5.52499 --target=-0.648084,1.48438,-4.94668 --fov=75" ;;
        town) printf -- '--camera=%s\n' main square kitchen ;;
        *) printf -- '--camera=%s\n' 0 1 2 ;;
    esac
}

light_of() { [[ $1 != zdm2 ]] || echo --sun=0.4,-1,0.3 --sky=0.6,0.8,1.0; }

# Where a view stands that no room of the others leads to.
inside_of() { [[ $1 != san_miguel ]] || echo --inside=-14.0275,1.28214,-25.5574; }
