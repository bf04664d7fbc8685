"""Numbered drawings as keyframes of one object.

trace_frames   the operators, and writing keyframes as they come
playing        which files make which frames
sequence_job   the tracing itself, in processes of their own
"""
