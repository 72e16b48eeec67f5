"""What requests are made of."""
NUMBERS = [0, 1, -1, 0.3, 0.7, 1e-9, 1e9, 1e300, float('nan'), float('inf'), -float('inf')]
CABLES = ['rope', 'line', 'trunk', 'branch', 'rope_2', 'line_2', 'trunk_2']
PLACES = CABLES + ['flag', 'figure', 'plug', 'hook']
ATTACHMENTS = ['left', 'right', 'ceiling', 'trunk_start', 'grip', 'upper', 'lower', 'pin1', 'pin2', 'pin3']
FRAMES = ['', 'world', 'hand', 'plug']
SNAPSHOTS = ['one', 'two', 'three', 'four', 'five']
WORDS = PLACES + ATTACHMENTS + FRAMES + ['ball', 'wheel', 'clip', 'fork', 'nowhere', 'a b', '/hand', '\xe4\n%s', 'x' * 100000]
HANDLES = ['attachment/left', 'attachment/right', 'attachment/pin1', 'rope/0', 'rope/10', 'line/3', 'rope_2/1', 'attachment/upper',
           'attachment/grip', 'plug', 'hook/0', 'nobody', '']
BAD_SCENES = ['', 'cables: []', 'a: [1', '{materials: {m: {linear_density: .nan}}}', '[' * 1000, '#' * 2000000,
              'a: &a [1, 2]\nb: &b [*a, *a, *a]\nc: [*b, *b, *b]', 'cables: [{name: rope, length: 1, segments: 4000000000, material: none}]']
SHIPPED_SCENES = ['hanging_cable.yaml', 'swinging_payload.yaml', 'scenes/pile.yaml', 'examples/plug.yaml', 'examples/harness.yaml']
