"""From pictures to Grease Pencil objects.

trace, import_scan, use_defaults   the operators
trace_settings, settings_layout    the engine's settings as properties, and how they are shown
sources, file_choice               what there is to trace
placing                            where a new object goes in the scene
background, trace_job              the tracing itself, in a thread, and how operators wait for it
networks                           which trained networks are there
"""
