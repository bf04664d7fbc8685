"""From pictures to Grease Pencil objects.

trace, import_scan, paste          the operators that trace
trace_again, live                  the same picture again, in place; by itself if wanted
choose_part, try_part, part        a part of it, to see what the settings do
use_defaults, use_preset           settings at one click; new scenes begin with the defaults
trace_settings, settings_layout    the engine's settings as properties, and how they are shown
sources, file_choice               what there is to trace
placing                            where a new object goes in the scene
scan_behind                        the scan behind its strokes
recent                             what was traced last is not traced again
background, trace_job              the tracing itself, in a thread, and how operators wait for it
networks                           which trained networks are there
"""
